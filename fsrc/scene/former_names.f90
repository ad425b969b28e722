!> Names that keys and quantities had in the version before: inputs that use them are read for one version, with a warning.
!> Results are written under the present names alone.
module former_names
   use text, only: lower
   implicit none(type, external)
   private

   type :: renaming_t
      character(40) :: former
      character(40) :: present
   end type renaming_t

   !> Keys, as group.key
   type(renaming_t), parameter :: keys(*) = [ &
      renaming_t('spectrum.certify', 'spectrum.verify'), &
      renaming_t('spectrum.certificate_tolerance', 'spectrum.verification_tolerance'), &
      renaming_t('spectrum.line_threshold', 'spectrum.harmonic_threshold'), &
      renaming_t('spectrum.idle_lines', 'spectrum.idle_harmonics')]

   !> Quantities, which are columns, words of keys, and keys of summaries
   type(renaming_t), parameter :: quantities(*) = [ &
      renaming_t('line_count', 'harmonic_count'), &
      renaming_t('line_count_is_bound', 'harmonic_count_is_bound'), &
      renaming_t('lines_by_integrals', 'harmonics_by_integrals'), &
      renaming_t('loudness_error', 'severity_error'), &
      renaming_t('certified', 'verified')]

   public :: present_key, present_word, renamed_text

contains

   !> Present name of a key, the name itself where it never had another.
   pure function present_key(group, name) result(present)
      !> Namelist group, lower case
      character(*), intent(in) :: group
      !> Name in the group, lower case
      character(*), intent(in) :: name
      character(:), allocatable :: present

      present = renamed(keys, group//'.'//name)
      present = present(len(group) + 2:)
   end function present_key

   !> Present name of a key, as group.key, or of a quantity; any other word as it is.
   pure function present_word(word) result(present)
      character(*), intent(in) :: word
      character(:), allocatable :: present

      present = renamed(quantities, word)
      if (index(word, '.') > 0 .and. renamed(keys, lower(word)) /= lower(word)) present = renamed(keys, lower(word))
   end function present_word

   !> What a user is told who wrote a former name.
   pure function renamed_text(former, present) result(words)
      character(*), intent(in) :: former
      character(*), intent(in) :: present
      character(:), allocatable :: words

      words = former//' is called '//present//' now; the former name is read in this version for the last time'
   end function renamed_text

   pure function renamed(renamings, name) result(present)
      type(renaming_t), intent(in) :: renamings(:)
      character(*), intent(in) :: name
      character(:), allocatable :: present
      integer :: position

      present = name
      position = findloc(renamings%former == name, .true., dim=1)
      if (position > 0) present = trim(renamings(position)%present)
   end function renamed

end module former_names
