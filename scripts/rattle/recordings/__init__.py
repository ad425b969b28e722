"""Recordings of a test bench: channels of files, the angle of a shaft, mean cycles, run-ups, encoders."""

from rattle.recordings.angle import ShaftAngle, resample_on_angle, shaft_angle
from rattle.recordings.channels import Channel, choose, read_channels, with_units
from rattle.recordings.cycles import MeanCycle, mean_cycle
from rattle.recordings.faults import RecordingError

__all__ = [
    "Channel",
    "MeanCycle",
    "RecordingError",
    "ShaftAngle",
    "choose",
    "mean_cycle",
    "read_channels",
    "resample_on_angle",
    "shaft_angle",
    "with_units",
]
