"""A toy law: the film of two parallel plates of length R, W = a/h - b w/h^3, with a of (23)."""

from __future__ import annotations

import subprocess
from math import isclose
from pathlib import Path

import scene
from run_touched import ToyError, Tree

INPUT = scene.scene_text(law="parallel-plates")
LAW = "fsrc/film/film_law.f90"
KERNEL = """!> The film of two parallel plates under rolling and squeeze.
module parallel_plates
   use kinds, only: dp
   implicit none(type, external)
   private

   public :: plate_damping, plate_load

contains

   !> Coefficient of -w h^(-3) of the load [N s m2].
   elemental real(dp) function plate_damping(length, viscosity, radius)
      !> Contact length l [m]
      real(dp), intent(in) :: length
      !> Viscosity eta0 [Pa s]
      real(dp), intent(in) :: viscosity
      !> Equivalent radius R, the length of the plates [m]
      real(dp), intent(in) :: radius

      plate_damping = 1.0e-3_dp*viscosity*length*radius**3
   end function plate_damping

   !> Load of the plates and its slopes.
   elemental subroutine plate_load(rolling, damping, film, velocity, load, load_by_film, load_by_velocity)
      !> Coefficient of 1/h [N m]
      real(dp), intent(in) :: rolling
      !> Coefficient of -w h^(-3) [N s m2]
      real(dp), intent(in) :: damping
      !> Film thickness h > 0 [m]
      real(dp), intent(in) :: film
      !> Film velocity w = dh/dt [m/s]
      real(dp), intent(in) :: velocity
      !> Load W [N]
      real(dp), intent(out) :: load
      !> dW/dh [N/m]
      real(dp), intent(out) :: load_by_film
      !> dW/dw [N s/m]
      real(dp), intent(out) :: load_by_velocity

      load_by_velocity = -damping/(film*film*film)
      load = rolling/film + load_by_velocity*velocity
      load_by_film = -(rolling/film + 3.0_dp*load_by_velocity*velocity)/film
   end subroutine plate_load

end module parallel_plates
"""
WRAPPER = """   !> Parallel plates; interface film_kernel.
   pure subroutine load_plates(film, thickness, velocity, load, load_by_film, load_by_velocity)
      type(film_t), intent(in) :: film
      real(dp), intent(in) :: thickness
      real(dp), intent(in) :: velocity
      real(dp), intent(out) :: load
      real(dp), intent(out) :: load_by_film
      real(dp), intent(out) :: load_by_velocity

      call plate_load(film%rolling, film%plates, thickness, velocity, load, load_by_film, load_by_velocity)
   end subroutine load_plates

"""
INVERSE = """      case (kernel_plates)
         outcome = load_carried
         velocity_by_load = -thickness**3/film%plates
         velocity = (load - film%rolling/thickness)*velocity_by_load
         velocity_by_film = 3.0_dp*velocity/thickness + film%rolling/thickness**2*velocity_by_load
"""
COEFFICIENTS = """         case (kernel_plates)
            film%rolling = rolling_coefficient(contact%length, film%speed, film%viscosity, film%radius)
            film%plates = plate_damping(contact%length, film%viscosity, film%radius)
"""


def change(tree: Tree) -> None:
    tree.add("fsrc/film/parallel_plates.f90", KERNEL)
    scene.add_law(tree, "law_plates", "parallel-plates")
    tree.put(LAW, "   use published_iso_viscous", "   use parallel_plates, only: plate_damping, plate_load\n")
    tree.change(
        LAW, "law_piezo_viscous, model_closure", "law_piezo_viscous, law_plates, &\n      model_closure"
    )
    tree.change(LAW, "kernel_closure = 7\n", "kernel_closure = 7, kernel_plates = 8\n")
    field = "      !> Parallel plates: coefficient of -w h^(-3) [N s m2]\n      real(dp) :: plates = 0.0_dp\n"
    tree.put(LAW, "      !> What it means if the kernel gives a load above", field)
    tree.put(LAW, "         case default\n            film%kernel = 0\n", COEFFICIENTS)
    chosen = "         if (choice%law == law_plates) kernel = kernel_plates\n"
    tree.put(LAW, "         if (choice%law /= law_iso_viscous) return\n", chosen)
    kernel = "      case (kernel_plates)\n         kernel => load_plates\n"
    tree.put(LAW, "      case default\n         kernel => null()\n", kernel)
    steady = "      case (kernel_plates)\n         steady_film = film%rolling/load\n"
    tree.put(LAW, "      case default\n         steady_film = 0.0_dp\n", steady)
    tree.put(LAW, "      case default\n         outcome = load_too_small\n", INVERSE)
    words = "      case (kernel_plates)\n         words = 'film of parallel plates'\n"
    tree.put(LAW, "      case default\n         words = 'unknown film law'\n", words)
    tree.put(LAW, "   !> (37); interface film_kernel.\n", WRAPPER)


def look(folder: Path, scratch: Path) -> None:
    """The steady film is that of (23), and elastic teeth take the law as well."""
    reported = scene.read_summary(folder / "law.summary.nml")
    if reported["law"] != "parallel-plates" or reported["rattle_class"] not in ("quiet", "creep", "idle"):
        raise ToyError(f"its summary tells {reported['law']}, {reported['rattle_class']}")
    steady = scene.ROLLING / (scene.STEADY_FORCE + scene.MASS * scene.GRAVITY)
    if not isclose(reported["steady_film"], steady, rel_tol=1e-9):
        raise ToyError(f"its steady film is {reported['steady_film']}, not {steady}")
    stiff = ["--set", "contact.stiffness=1e12", "--set", "scene.name=stiff", "law.nml"]
    subprocess.run([scratch / "build/rattle", "--quiet", "--output", ".", *stiff], cwd=folder, check=True)
    elastic = scene.read_summary(folder / "stiff.summary.nml")
    if not isclose(elastic["film_minimum"], reported["film_minimum"], rel_tol=1e-3):
        raise ToyError(
            f"its film is {reported['film_minimum']}, between stiff teeth {elastic['film_minimum']}"
        )
