"""A toy task: the steady films under a list of loads."""

from __future__ import annotations

from math import isclose
from pathlib import Path

import scene
from run_touched import ToyError, Tree

LOADS = 100.0, 200.0, 400.0
ASKED = f"""&scene
   task = 'rest'
/
&rest
   loads = {", ".join(map(str, LOADS))}
/
"""
INPUT = scene.scene_text(more=ASKED)
TYPES, TABLE = "fsrc/scene/scene_types.f90", "fsrc/scene/key_table.f90"
READER, GROUPS = "fsrc/scene/scene_reader.f90", "fsrc/scene/task_reader.f90"
BATCH = "fsrc/run/batch.f90"
TYPE = """   !> &rest
   type, public :: rest_t
      !> Loads [N]
      real(dp), allocatable :: loads(:)
   end type rest_t

"""
ROW = """      key_t('rest', 'loads', reals_kind, 'N', 'required', positive, '', 'scene.task=rest', &
            'Loads whose steady films are wanted.', &
            example='200.0'), &
"""
READ = """   !> &rest
   function read_rest(input) result(rest)
      type(scene_input_t), intent(in) :: input
      type(rest_t) :: rest

      allocate (rest%loads, source=input%numbers('rest.loads'))
   end function read_rest

"""
TASK = """!> The steady films under a list of loads, from input to files.
module run_rest
   use errors, only: error_t
   use finished_files, only: place_files
   use kinds, only: dp, int64
   use log_file, only: log_t
   use output_place, only: log_path, result_path, summary_path
   use problem, only: film_at_rest, problem_of
   use result_writer, only: result_writer_t
   use scene_report, only: law_sentence, report_head
   use scene_status, only: status_complete
   use scene_summary, only: add_head, add_results
   use scene_types, only: scene_t
   use summary_file, only: summary_t
   use word_list, only: word_t
   implicit none(type, external)
   private

   public :: run_rest_task

contains

   !> Run the task and write its files.
   subroutine run_rest_task(scene, quiet, status, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> Nothing to the terminal
      logical, intent(in) :: quiet
      !> Status of scene_status
      integer, intent(out) :: status
      !> Set if a file could not be written
      type(error_t), allocatable, intent(out) :: error
      type(log_t) :: log
      type(result_writer_t) :: table
      type(summary_t) :: summary
      type(word_t) :: paths(1)
      real(dp) :: rows(2, size(scene%rest%loads))
      integer :: i

      status = status_complete
      rows(1, :) = scene%rest%loads
      do i = 1, size(rows, 2)
         rows(2, i) = film_at_rest(problem_of(scene), rows(1, i))
      end do
      call log%open(log_path(scene), quiet, error)
      if (allocated(error)) return
      call report_head(log, scene, law_sentence(scene))
      call log%close()
      call table%open(result_path(scene), scene%resolved_input, ['load       ', 'steady_film'], ['N', 'm'], &
                      size(rows, 2, int64), .true., error)
      if (.not. allocated(error)) call table%write_rows(rows, error)
      if (.not. allocated(error)) call table%close(error)
      if (allocated(error)) return
      paths(1)%text = result_path(scene)
      call add_head(summary, scene, status)
      call add_results(summary, paths, status)
      call summary%write_beside(summary_path(scene), error)
      if (.not. allocated(error)) call place_files(paths, summary_path(scene), error)
   end subroutine run_rest_task

end module run_rest
"""


def change(tree: Tree) -> None:
    tree.change(TYPES, "task_threshold = 5\n", "task_threshold = 5, &\n      task_rest = 6\n")
    tree.change(TYPES, "sweep campaign threshold'", "sweep campaign threshold rest'")
    tree.put(TYPES, "   !> &output\n", TYPE)
    tree.put(TYPES, "      type(output_t) :: output\n", "      type(rest_t) :: rest\n")
    tree.put(TABLE, "      key_t('output', 'directory', ", ROW)
    tree.change(TABLE, "of_motions = 'scene.task=motion|", "of_motions = 'scene.task=rest|motion|")
    tree.change(GROUPS, "public :: read_points, ", "public :: read_rest, read_points, ")
    tree.change(GROUPS, "model_published, sweep_t", "model_published, rest_t, sweep_t")
    tree.put(GROUPS, "   !> &sweep\n", READ)
    tree.change(READER, "read_points, read_sweep", "read_points, read_rest, read_sweep")
    tree.change(READER, "task_motion, &", "task_motion, task_rest, &")
    read = "      if (scene%task == task_rest) scene%rest = read_rest(input)\n"
    tree.put(READER, "      scene%output = read_output(input)\n", read)
    tree.add("fsrc/run/run_rest.f90", TASK)
    tree.put(BATCH, "   use run_scene", "   use run_rest, only: run_rest_task\n")
    tree.change(BATCH, "task_motion, task_sweep", "task_motion, task_rest, task_sweep")
    call = "      case (task_rest)\n         call run_rest_task(scene, command%quiet, status, error)\n"
    tree.put(BATCH, "      case (task_sweep)\n         call run_sweep", call)


def look(folder: Path, scratch: Path) -> None:
    rows = scene.read_table(folder / "task.rattle", scratch)
    if tuple(rows["load"]) != LOADS:
        raise ToyError(f"its table has the loads {rows['load']}")
    for load, film in zip(rows["load"], rows["steady_film"], strict=True):
        if not isclose(film, scene.ROLLING / load, rel_tol=1e-9):
            raise ToyError(f"its film under {load} N is {film}, not {scene.ROLLING / load}")
