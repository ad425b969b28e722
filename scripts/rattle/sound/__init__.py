"""From film forces to a sound: force over a period, transfer to sound pressure, samples, levels."""
