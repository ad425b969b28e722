"""The compiled kernels, of whose arguments a checker of types sees nothing; rattle.kernels declares them."""

from typing import Any

def __getattr__(name: str) -> Any: ...
