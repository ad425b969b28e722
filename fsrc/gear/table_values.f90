!> What measured tables say between their rows: the drag torque over speed and temperature, the orders of a shaft over speed.
module table_values
   use constants, only: pi, two_pi
   use kinds, only: dp
   use scene_types, only: drag_table_t, excitation_table_t
   implicit none(type, external)
   private

   public :: torque_of_table, excitation_at, is_within

contains

   !> Torque at a speed and a temperature within the table [N m], linear along both.
   pure real(dp) function torque_of_table(table, speed_rpm, temperature) result(torque)
      type(drag_table_t), intent(in) :: table
      !> [1/min]
      real(dp), intent(in) :: speed_rpm
      !> [degC]
      real(dp), intent(in) :: temperature
      integer :: i, j, i_next, j_next
      real(dp) :: by_speed, by_temperature

      call find_cell(table%speeds, speed_rpm, i, i_next, by_speed)
      call find_cell(table%temperatures, temperature, j, j_next, by_temperature)
      torque = between(between(table%torques(i, j), table%torques(i_next, j), by_speed), &
                       between(table%torques(i, j_next), table%torques(i_next, j_next), by_speed), by_temperature)
   end function torque_of_table

   !> Amplitudes and phases of all orders at a speed within the table: amplitudes are linear in it, phases go the short way round.
   pure subroutine excitation_at(table, speed_rpm, accelerations, phases)
      type(excitation_table_t), intent(in) :: table
      !> [1/min]
      real(dp), intent(in) :: speed_rpm
      !> [rad/s2] and [rad], one for each order
      real(dp), allocatable, intent(inout) :: accelerations(:)
      real(dp), allocatable, intent(inout) :: phases(:)
      integer :: i, next
      real(dp) :: share

      call find_cell(table%speeds, speed_rpm, i, next, share)
      accelerations = between(table%accelerations(i, :), table%accelerations(next, :), share)
      phases = table%phases(i, :) + share*(modulo(table%phases(next, :) - table%phases(i, :) + pi, two_pi) - pi)
   end subroutine excitation_at

   !> Whether a value lies within the rows of an axis.
   pure logical function is_within(axis, value)
      !> Ascending
      real(dp), intent(in) :: axis(:)
      real(dp), intent(in) :: value

      is_within = value >= axis(1) .and. value <= axis(size(axis))
   end function is_within

   !> The rows on both sides of a value, and its share of the way from one to the other; beyond the ends the last row.
   pure subroutine find_cell(axis, value, row, next, share)
      !> Ascending
      real(dp), intent(in) :: axis(:)
      real(dp), intent(in) :: value
      integer, intent(out) :: row
      integer, intent(out) :: next
      real(dp), intent(out) :: share

      row = max(1, count(axis <= value))
      next = min(row + 1, size(axis))
      share = 0.0_dp
      if (next > row .and. value > axis(row)) share = (value - axis(row))/(axis(next) - axis(row))
   end subroutine find_cell

   !> A share of the way from one number to another; both ends exactly.
   elemental real(dp) function between(from, to, share)
      real(dp), intent(in) :: from
      real(dp), intent(in) :: to
      real(dp), intent(in) :: share

      between = (1.0_dp - share)*from + share*to
   end function between

end module table_values
