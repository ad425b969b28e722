!> The table of outcomes, in Markdown for the reader and as CSV.
module stress_table
   use kinds, only: dp, int64
   use random_scenes, only: law_names, laws
   use stress_engines, only: engine_names, engines
   use stress_outcomes, only: outcome_names, outcome_silent, outcome_t, outcomes
   use text, only: integer_text
   implicit none(type, external)
   private

   !> Ratio of error to accuracy at the edge of the highest class; the classes are half powers of ten.
   integer, parameter :: classes = 24, lowest_class = -12

   !> All that is counted.
   type, public :: tally_t
      !> Scenes by outcome, law and engine
      integer(int64) :: count(outcomes, laws, engines) = 0_int64
      !> Scenes given up that the tight solution can solve
      integer(int64) :: needless(laws, engines) = 0_int64
      !> Ratios of error to accuracy, by class
      integer(int64) :: ratios(classes, engines) = 0_int64
   contains
      procedure :: add
      procedure :: failures
   end type tally_t

   public :: print_markdown, print_ratios, write_csv

contains

   !> Count an outcome.
   subroutine add(self, law, engine, outcome)
      class(tally_t), intent(inout) :: self
      !> Place in `law_names`
      integer, intent(in) :: law
      !> Place in `engine_names`
      integer, intent(in) :: engine
      !> The outcome
      type(outcome_t), intent(in) :: outcome
      integer :: class

      self%count(outcome%code, law, engine) = self%count(outcome%code, law, engine) + 1_int64
      if (outcome%error < 0.0_dp .and. outcome%solvable .and. outcome%code /= outcome_silent) &
         self%needless(law, engine) = self%needless(law, engine) + 1_int64
      if (outcome%ratio < 0.0_dp) return
      class = ceiling(2.0_dp*log10(max(outcome%ratio, 1.0e-30_dp))) - lowest_class
      class = max(1, min(classes, class))
      self%ratios(class, engine) = self%ratios(class, engine) + 1_int64
   end subroutine add

   !> Number of silent failures.
   pure integer(int64) function failures(self)
      class(tally_t), intent(in) :: self

      failures = sum(self%count(outcome_silent, :, :))
   end function failures

   !> Table as Markdown: a row for every law and engine.
   subroutine print_markdown(tally)
      type(tally_t), intent(in) :: tally
      integer :: law, engine, i

      print '(100a)', '| film | engine |', (' '//trim(outcome_names(i))//' |', i=1, outcomes), &
         ' given up, yet solvable |'
      print '(100a)', '|---|---|', ('---:|', i=1, outcomes + 1)
      do engine = 1, engines
         do law = 1, laws
            if (sum(tally%count(:, law, engine)) == 0_int64) cycle
            call print_row(trim(law_names(law)), trim(engine_names(engine)), tally%count(:, law, engine), &
                           tally%needless(law, engine))
         end do
         if (sum(tally%count(:, :, engine)) == 0_int64) cycle
         call print_row('**all**', trim(engine_names(engine)), sum(tally%count(:, :, engine), dim=2), &
                        sum(tally%needless(:, engine)))
      end do
   end subroutine print_markdown

   !> One row.
   subroutine print_row(film, engine, counts, needless)
      character(*), intent(in) :: film
      character(*), intent(in) :: engine
      integer(int64), intent(in) :: counts(:)
      integer(int64), intent(in) :: needless
      integer :: i

      print '(100a)', '| '//film//' | '//engine//' |', (' '//integer_text(counts(i))//' |', i=1, outcomes), &
         ' '//integer_text(needless)//' |'
   end subroutine print_row

   !> Shares of the ratios of error to accuracy.
   subroutine print_ratios(tally)
      type(tally_t), intent(in) :: tally
      integer :: engine, i

      print '(a)', '| error over accuracy up to |'//repeat_names()
      print '(a)', '|---:|'//repeat('---:|', engines)
      do i = 1, classes
         if (sum(tally%ratios(i, :)) == 0_int64) cycle
         print '(a, es8.1, 20(a, f8.3))', '| ', 10.0_dp**(0.5_dp*real(i + lowest_class, dp)), &
            (' | ', share(i, engine), engine=1, engines), ' |'
      end do

   contains

      !> Scenes up to a class [%].
      pure real(dp) function share(class, engine)
         integer, intent(in) :: class
         integer, intent(in) :: engine

         share = 100.0_dp*real(sum(tally%ratios(:class, engine)), dp)/ &
                 real(max(1_int64, sum(tally%ratios(:, engine))), dp)
      end function share

      !> Heads of the columns.
      function repeat_names() result(line)
         character(:), allocatable :: line
         integer :: place

         line = ''
         do place = 1, engines
            line = line//' '//trim(engine_names(place))//' [%] |'
         end do
      end function repeat_names

   end subroutine print_ratios

   !> Table as CSV.
   subroutine write_csv(path, tally, written)
      !> File, replaced
      character(*), intent(in) :: path
      type(tally_t), intent(in) :: tally
      !> Whether it could be written
      logical, intent(out) :: written
      integer :: unit, failure, law, engine, i

      open (newunit=unit, file=path, status='replace', action='write', iostat=failure)
      written = failure == 0
      if (.not. written) return
      write (unit, '(100a)') 'film,engine', (','//trim(outcome_names(i)), i=1, outcomes), &
         ',given up yet solvable'
      do engine = 1, engines
         do law = 1, laws
            write (unit, '(100a)') '"'//trim(law_names(law))//'","'//trim(engine_names(engine))//'"', &
               (','//integer_text(tally%count(i, law, engine)), i=1, outcomes), ','// &
               integer_text(tally%needless(law, engine))
         end do
      end do
      close (unit)
   end subroutine write_csv

end module stress_table
