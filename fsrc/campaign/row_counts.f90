!> What is counted of the rows of a campaign, for its progress, its log and its summary.
module row_counts
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use kinds, only: dp, int64
   use rattle_class, only: class_irregular, class_irregular_so_far
   use regime_check, only: outside_closure
   use scene_status, only: is_success
   implicit none(type, external)
   private

   !> Scenes solved, and those of them that failed
   integer, parameter, public :: count_done = 1, count_failed = 2
   !> Scenes whose motion leaves what the model can mean, and whose harmonics no samples follow and no integrals could be had for
   integer, parameter, public :: count_beyond_model = 3, count_undersampled = 4
   !> Scenes whose class was put to the test, and those of them whose class does not stand
   integer, parameter, public :: count_tested = 5, count_uncertain = 6
   !> Scenes whose motion is irregular, and irregular only so far
   integer, parameter, public :: count_irregular = 7, count_irregular_so_far = 8
   !> Scenes whose motions are known, and those of them that have several
   integer, parameter, public :: count_followed = 9, count_several = 10
   !> Scenes whose film is extrapolated by its closure
   integer, parameter, public :: count_extrapolated = 11
   integer, parameter, public :: counts_of_rows = 11

   public :: count_rows

contains

   !> Count rows. Of a column that is not recorded nothing is counted, nor of values that are not known.
   pure function count_rows(names, status_column, rows) result(counts)
      !> Names of the columns, and which of them is the status
      character(*), intent(in) :: names(:)
      integer, intent(in) :: status_column
      !> One column of this array is the row of a scene
      real(dp), intent(in) :: rows(:, :)
      integer(int64) :: counts(counts_of_rows)

      counts(count_done) = size(rows, 2, kind=int64)
      counts(count_failed) = count(.not. is_success(nint(rows(status_column, :))), kind=int64)
      counts(count_beyond_model) = count_between('model_limit', 1.0_dp, huge(1.0_dp))
      counts(count_undersampled) = count_between('sampling_sufficient', 0.0_dp, 0.0_dp)
      counts(count_tested) = count_between('verified', 0.0_dp, 1.0_dp)
      counts(count_uncertain) = count_between('verified', 0.0_dp, 0.0_dp)
      counts(count_irregular) = count_between('rattle_class', real(class_irregular, dp), real(class_irregular, dp))
      counts(count_irregular_so_far) = count_between('rattle_class', real(class_irregular_so_far, dp), &
                                                     real(class_irregular_so_far, dp))
      counts(count_followed) = count_between('motions', 1.0_dp, huge(1.0_dp))
      counts(count_several) = count_between('motions', 2.0_dp, huge(1.0_dp))
      counts(count_extrapolated) = count_between('closure_range', real(outside_closure, dp), real(outside_closure, dp))

   contains

      pure integer(int64) function count_between(name, least, most)
         character(*), intent(in) :: name
         real(dp), intent(in) :: least
         real(dp), intent(in) :: most
         integer :: column

         count_between = 0_int64
         column = findloc(names == name, .true., dim=1)
         if (column == 0) return
         associate (values => rows(column, :))
            count_between = count(.not. ieee_is_nan(values) .and. values >= least .and. values <= most, kind=int64)
         end associate
      end function count_between

   end function count_rows

end module row_counts
