#!/bin/sh
# Prints the module of the ready inputs that rattle --template NAME gives. Usage: write_ready_inputs.sh NAME=FILE ...
set -eu

# A file as statements that build its text, in pieces that fit into lines of Fortran.
statements() {
    sed "s/'/''/g" "$1" | awk '{
        while (length($0) > 90) {
            cut = 90
            while (substr($0, cut, 1) == "\047") cut--
            print "         text = text//\047" substr($0, 1, cut) "\047"
            $0 = substr($0, cut + 1)
        }
        print "         text = text//\047" $0 "\047//end_of_line"
    }'
}

names=$(for pair; do printf '%s ' "${pair%%=*}"; done)
cat << END
!> Ready inputs, which stand in the program: rattle --template NAME.
module ready_inputs
   implicit none(type, external)
   private

   !> Their names
   character(*), parameter, public :: ready_names = '${names% }'

   public :: ready_input

contains

   !> Text of a ready input, empty for any other name.
   pure function ready_input(name) result(text)
      character(*), intent(in) :: name
      character(:), allocatable :: text
      character(1), parameter :: end_of_line = new_line('a')

      text = ''
      select case (name)
END
for pair; do
    echo "      case ('${pair%%=*}')"
    statements "${pair#*=}"
done
cat << END
      case default
         continue
      end select
   end function ready_input

end module ready_inputs
END
