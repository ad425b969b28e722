"""The checksum of result files, as fsrc/foundation/checksum.f90 defines it.

The words of 64 bits are dealt in turn to 509 lanes, those of a lane joined by exclusive or; each lane is
mixed with its place, and the mixed lanes are joined. Only the first pass sees all the data.
"""

from __future__ import annotations

import numpy as np

LANES = 509
# Words that are dealt at once, so that they stay in the cache.
BLOCK = LANES * 256
LOW = np.uint64(0xFFFFFFFF)
HALF = np.uint64(32)
PLACES = np.arange(LANES + 1, dtype=np.uint64) * np.uint64(0x5E3779B1)
MULTIPLIERS = tuple(map(np.uint64, (0x7FEB352D, 0x6C8E9CF5, 0x58F38DED)))


def checksum(data: bytes | np.ndarray) -> int:
    """The checksum of bytes, or of an array of float64 in the order of storage; a signed number, not 0."""
    if isinstance(data, bytes):
        byte_count = len(data)
        words = np.frombuffer(data.ljust(-(-byte_count // 8) * 8, b"\0"), dtype="<u8")
    else:
        byte_count = 8 * data.size
        words = np.ascontiguousarray(data).reshape(-1).view("<u8")
    lanes = np.zeros(LANES + 1, dtype=np.uint64)
    lanes[0] = byte_count
    for start in range(0, words.size, BLOCK):
        block = words[start : start + BLOCK]
        whole = block.size // LANES * LANES
        if whole:
            lanes[1:] ^= np.bitwise_xor.reduce(block[:whole].reshape(-1, LANES), axis=0)
        lanes[1 : 1 + block.size - whole] ^= block[whole:]
    return int(np.bitwise_xor.reduce(_mixed(lanes)).view(np.int64)) or 1


def checksums(blocks: np.ndarray) -> np.ndarray:
    """The checksum of each row of a table of float64, all at once where they are short."""
    count, size = blocks.shape
    if size > LANES:
        return np.array([checksum(block) for block in blocks], dtype=np.int64)
    words = np.ascontiguousarray(blocks).view("<u8")
    idle = np.zeros(LANES + 1 - size, dtype=np.uint64)
    idle[0] = 8 * size
    places = np.append(PLACES[:1], PLACES[1 + size :])
    sums = np.bitwise_xor.reduce(_mixed(idle, places)) ^ np.bitwise_xor.reduce(
        _mixed(words, PLACES[1 : 1 + size]), axis=1
    )
    sums[sums == 0] = 1
    return sums.view(np.int64).reshape(count)


def _mixed(lanes: np.ndarray, places: np.ndarray = PLACES) -> np.ndarray:
    """Each lane mixed with its place; it can be undone, so no change of a lane is lost."""
    keyed = lanes ^ places
    high, low = keyed >> HALF, keyed & LOW
    high ^= _folded(low * MULTIPLIERS[0])
    low ^= _folded(high * MULTIPLIERS[1])
    high ^= _folded(low * MULTIPLIERS[2])
    return (high << HALF) | low


def _folded(product: np.ndarray) -> np.ndarray:
    return (product ^ (product >> HALF)) & LOW
