!> Which film laws have a Taylor series of the motion, of what order, and how good it is.
!>
!> The series themselves are in modules taylor_iso_viscous and taylor_piezo_viscous, for the published films, and
!> taylor_rupture and taylor_reynolds_piezo, for those whose rupture follows from (18). A law without a series is solved by
!> collocation.
module film_series
   use film_law, only: film_t, kernel_half_pi, kernel_piezo, kernel_reynolds_iso, kernel_reynolds_piezo, kernel_solved_fast
   use kinds, only: dp
   use taylor_rupture, only: rupture_order
   use taylor_step_control, only: order
   implicit none(type, external)
   private

   !> Best accuracy of a motion by the cells of the exact piezo-viscous film, whose loads are good to 6e-12.
   real(dp), parameter :: best_cell_accuracy = 1.0e-10_dp

   !> The series of a film law.
   type, public :: film_series_t
      !> The law
      integer :: kernel = kernel_half_pi
      !> Whether there is one, and whether its rupture follows from (18)
      logical :: exists = .false., solves_rupture = .false.
      !> Order of its last coefficient
      integer :: last_order = order
      !> Share of the accuracy that a step of length x may use up is x times this; found by trial [1/periods]
      real(dp) :: share = 4.0_dp
      !> Relative accuracy of the film below which collocation is used [-]
      real(dp) :: best_accuracy = 0.0_dp
   end type film_series_t

   public :: series_of, has_series

contains

   !> The series of a film law.
   elemental type(film_series_t) function series_of(kernel)
      !> Its kernel
      integer, intent(in) :: kernel

      series_of%kernel = kernel
      select case (kernel)
      case (kernel_half_pi, kernel_piezo)
         series_of%exists = .true.
      case (kernel_solved_fast, kernel_reynolds_iso)
         series_of = film_series_t(kernel, .true., .true., rupture_order, share=8.0_dp)
      case (kernel_reynolds_piezo)
         ! Its long steps add up their errors where nothing damps.
         series_of = film_series_t(kernel, .true., .true., rupture_order, share=2.0_dp, best_accuracy=best_cell_accuracy)
      case default
         series_of%exists = .false.
      end select
   end function series_of

   !> Whether the film law has a Taylor series that is good enough.
   elemental logical function has_series(film, accuracy)
      !> The film
      type(film_t), intent(in) :: film
      !> Relative accuracy of the film asked for [-]
      real(dp), intent(in) :: accuracy
      type(film_series_t) :: series

      series = series_of(film%kernel)
      has_series = series%exists .and. accuracy >= series%best_accuracy
   end function has_series

end module film_series
