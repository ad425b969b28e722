!> Tests of the text that a terminal may see.
module test_printable_text
   use checks, only: check_list_t
   use text, only: printable
   implicit none(type, external)
   private

   public :: run_printable_text_tests

contains

   !> Runs every test of this topic.
   subroutine run_printable_text_tests(checks)
      !> Collects the results
      type(check_list_t), intent(inout) :: checks

      call checks%start('printable_text')
      call shown('plain ~ text', 'plain ~ text', 'ASCII')
      call shown(achar(27)//'[31m', '\x1B[31m', 'a command of the terminal')
      call shown(achar(9)//achar(0)//achar(127), '\x09\x00\x7F', 'control characters')
      call shown('a'//new_line('a')//'b', 'a\x0Ab', 'a line feed in one line')
      call checks%check(printable('a'//new_line('a')//'b', .true.) == 'a'//new_line('a')//'b', 'a line feed that may stay')
      call shown(char(195)//char(164), char(195)//char(164), 'a letter of two bytes')
      call shown(char(226)//char(130)//char(172), char(226)//char(130)//char(172), 'a sign of three bytes')
      call shown(char(240)//char(159)//char(153)//char(130), char(240)//char(159)//char(153)//char(130), 'one of four bytes')
      call shown(char(255)//'x', '\xFFx', 'a byte that is no text')
      call shown(char(195)//'x', '\xC3x', 'a character cut short')
      call shown(char(226)//char(130), '\xE2\x82', 'a character cut short at the end')
      call shown(char(194)//char(155), '\xC2\x9B', 'a command of the terminal in two bytes')
      call shown(char(192)//char(155), '\xC0\x9B', 'a control character in too many bytes')
      call shown(char(224)//char(130)//char(155), '\xE0\x82\x9B', 'a command in too many bytes')
      call shown(char(240)//char(130)//char(130)//char(172), '\xF0\x82\x82\xAC', 'a sign in too many bytes')
      call shown(char(237)//char(160)//char(128), '\xED\xA0\x80', 'half a character')
      call shown(char(244)//char(144)//char(128)//char(128), '\xF4\x90\x80\x80', 'beyond all characters')
      call shown('', '', 'nothing')

   contains

      subroutine shown(text, expected, message)
         character(*), intent(in) :: text
         character(*), intent(in) :: expected
         character(*), intent(in) :: message

         call checks%check(printable(text, .false.) == expected .and. len(printable(text, .false.)) == len(expected), message)
      end subroutine shown

   end subroutine run_printable_text_tests

end module test_printable_text
