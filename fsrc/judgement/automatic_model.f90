!> `film.model = 'automatic'`: a motion is solved by the closure, and in nodes of pressure where the closure is outside the loads
!> that it was fitted to, where it ended without a window, or where the verdict stands so near its limit that an error of the
!> closure could change it.
module automatic_model
   use elastohydrodynamic_closure, only: error_of_loads
   use errors, only: error_t
   use judged_scene, only: judged_scene_t, largest_load
   use kinds, only: dp
   use node_extremes, only: seen_loads, seen_net_load_of
   use problem, only: contact_count, largest_applied_force
   use regime_check, only: closure_range, closure_range_sentence, outside_closure
   use scene_solution, only: solve_in_memory
   use scene_status, only: is_success, status_film_cycles, status_film_torn, status_interrupted, status_name
   use scene_types, only: model_resolved, scene_t
   use text, only: short_text
   implicit none(type, external)
   private

   !> Accuracy of films in nodes, their default
   real(dp), parameter :: nodal_accuracy = 3.0e-3_dp

   !> Why a motion is solved in nodes; and load, limit [N] and error of the closure [-] where that is what it is about.
   integer, parameter :: because_closure_ended = 1, because_out_of_range = 2, because_of_impact = 3, because_of_separation = 4
   type, public :: reason_t
      !> 0: it is not
      integer :: code = 0
      real(dp) :: load = 0.0_dp, limit = 0.0_dp, error = 0.0_dp
   end type reason_t

   public :: choose_model, closure_instead, reason_for_nodes, scene_in_nodes, nodes_stopped

contains

   !> The scene that is solved for one whose model is automatic: a motion by the closure, without verification, decides.
   subroutine choose_model(scene, chosen, error)
      !> Checked scene
      type(scene_t), intent(in) :: scene
      !> With closure or nodes, and the reason in words
      type(scene_t), intent(out) :: chosen
      !> Set if there is not enough memory
      type(error_t), allocatable, intent(out) :: error
      type(scene_t) :: tried
      type(judged_scene_t) :: judged
      type(reason_t) :: reason

      chosen = scene
      chosen%film%automatic = .false.
      tried = chosen
      tried%gearbox = ''
      tried%spectrum%verify = .false.
      call solve_in_memory(tried, judged, error)
      if (allocated(error)) return
      reason = reason_for_nodes(judged, scene%spectrum%impact_limit)
      if (reason%code == 0) then
         chosen%film%model_words = 'by the closure: its range and its verdict allow for its errors'
      else
         chosen = scene_in_nodes(chosen)
         chosen%film%model_words = 'in nodes: '//words_of(reason, judged)
      end if
   end subroutine choose_model

   !> The scene that is solved where films in nodes stop.
   pure type(scene_t) function closure_instead(scene, in_nodes, stopped) result(chosen)
      !> With the automatic model, and as it was to be solved in nodes
      type(scene_t), intent(in) :: scene
      type(scene_t), intent(in) :: in_nodes
      !> How films in nodes stopped
      character(*), intent(in) :: stopped

      chosen = scene
      chosen%film%automatic = .false.
      chosen%film%nodes_stopped = .true.
      chosen%film%model_words = 'by the closure, as films in nodes stopped ('//stopped//'); in nodes because '// &
                         in_nodes%film%model_words(len('in nodes: ') + 1:)
   end function closure_instead

   !> The scene with its films in nodes, from rest.
   pure type(scene_t) function scene_in_nodes(scene) result(in_nodes)
      !> Checked scene with the elastohydrodynamic law
      type(scene_t), intent(in) :: scene

      in_nodes = scene
      in_nodes%film%automatic = .false.
      in_nodes%film%model = model_resolved
      in_nodes%solver%accuracy = nodal_accuracy
      in_nodes%solver%starts = 1
   end function scene_in_nodes

   !> Whether a motion ended because pressures in nodes could not be found.
   elemental logical function nodes_stopped(status)
      !> Of scene_status
      integer, intent(in) :: status

      nodes_stopped = status == status_film_cycles .or. status == status_film_torn
   end function nodes_stopped

   !> Whether and why a motion by the closure is solved again in nodes. Numbers only: threads make no texts.
   pure type(reason_t) function reason_for_nodes(judged, impact_limit) result(reason)
      !> By the closure, with its extremes, impacts and regime
      type(judged_scene_t), intent(in) :: judged
      !> Loads above this multiple of the largest force are impacts [-]
      real(dp), intent(in) :: impact_limit
      real(dp) :: force, load
      integer :: contact

      if (judged%status == status_interrupted) return
      reason%code = because_closure_ended
      if (.not. is_success(judged%status)) return
      reason%code = because_out_of_range
      associate (film => judged%resolved%problem%contact%film, problem => judged%resolved%problem, extremes => judged%extremes)
         if (closure_range(film, largest_load(judged), judged%regime%pressure_maximum) == outside_closure) return
         reason%code = 0
         if (.not. judged%impacts%exists) return
         reason%error = error_of_loads(film%closure, largest_load(judged)/film%closure%load_unit)
         force = largest_applied_force(problem)
         reason%limit = impact_limit*force
         do contact = 1, contact_count(problem)
            reason%load = extremes%highest(seen_loads(contact))%value
            if (abs(reason%load - reason%limit) > reason%error*reason%load) cycle
            reason%code = because_of_impact
            return
         end do
         if (any(judged%impacts%contacts%count > 0)) return
         load = extremes%lowest(seen_net_load_of(problem))%value
         ! Without a change of sign the drive film may be unloaded for a time: errors count for that time as for loads.
         if (load > reason%error*force .and. .not. judged%impacts%unloaded_share > 0.0_dp) return
         if (load < -reason%error*force .or. judged%impacts%unloaded_share > reason%error) return
         reason%load = load
         reason%code = because_of_separation
      end associate
   end function reason_for_nodes

   !> The reason in words.
   function words_of(reason, judged) result(words)
      type(reason_t), intent(in) :: reason
      !> By the closure
      type(judged_scene_t), intent(in) :: judged
      character(:), allocatable :: words

      select case (reason%code)
      case (because_closure_ended)
         words = 'the closure ended with '//status_name(judged%status)
      case (because_out_of_range)
         words = closure_range_sentence(judged%resolved%problem%contact%film, largest_load(judged), judged%regime%pressure_maximum)
      case (because_of_impact)
         words = 'the largest load on a flank, '//short_text(reason%load, 5)//' N, is within the error of the closure, '// &
                 percent(reason%error)//', of the '//short_text(reason%limit, 5)//' N that make an impact'
      case default
         words = 'the least load, '//short_text(reason%load, 3)//' N, or the time without load is within the error of the '// &
                 'closure, '//percent(reason%error)//' of the largest force or of a period, of separation'
      end select
   end function words_of

   !> A share in words.
   pure function percent(share) result(words)
      real(dp), intent(in) :: share
      character(:), allocatable :: words

      words = short_text(100.0_dp*share, 2)//' %'
   end function percent

end module automatic_model
