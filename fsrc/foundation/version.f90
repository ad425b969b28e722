!> Version of the program, from the file VERSION.
module version
   implicit none(type, external)
   private

   character(*), parameter, public :: program_version = PROGRAM_VERSION

end module version
