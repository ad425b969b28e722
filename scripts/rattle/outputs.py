"""Files that scripts write: nothing is replaced unasked, and none stands half written under its name."""

from __future__ import annotations

import errno
import os
import stat
import tempfile
from argparse import _ActionsContainer
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

from rattle.command import CommandError

# Writes the content of a file under the name that it is given.
Writer = Callable[[Path], None]
# What os.link says where a file system has no links.
NO_LINKS = (errno.EPERM, errno.ENOTSUP, errno.EOPNOTSUPP, errno.ENOSYS, errno.EMLINK, errno.EXDEV)


def add_option(parser: _ActionsContainer) -> None:
    """The option of every script that writes."""
    parser.add_argument("--overwrite", action="store_true", help="replace files that are there already")


def check(paths: Iterable[Path], *, overwrite: bool, inputs: Iterable[Path] = ()) -> None:
    """Refuse paths that cannot be written, or must not be: `inputs` are never replaced."""
    seen: set[Path] = set()
    read = [path for path in inputs if path.exists()]
    for path in paths:
        place = path.parent.resolve() / path.name
        if place in seen:
            raise CommandError(f"two files would be called {path}.")
        seen.add(place)
        _check_folder(path.parent)
        try:
            kind = path.lstat().st_mode
        except FileNotFoundError:
            continue
        if path.is_dir():
            raise CommandError(f"{path} is a folder; give the name of a file.")
        if path.exists() and any(path.samefile(given) for given in read):
            raise CommandError(f"{path} is a result itself; give another --output.")
        # A link is replaced, not followed; one to a device would take the name of the device away.
        if not (stat.S_ISREG(kind) or (stat.S_ISLNK(kind) and (path.is_file() or not path.exists()))):
            raise CommandError(f"{path} is not a plain file; give another --output.")
        if not overwrite:
            raise CommandError(f"{path} exists; --overwrite replaces it.")


def write(
    files: Sequence[tuple[Path, Writer]],
    *,
    overwrite: bool,
    inputs: Iterable[Path] = (),
    make_folders: bool = True,
) -> list[Path]:
    """Write all files or, where a fault comes first, none; returns their paths.

    Each is written beside its place, under a name that no one can foresee, and moved when all are whole.
    """
    paths = [path for path, _ in files]
    check(paths, overwrite=overwrite, inputs=inputs)
    staged: list[Path] = []
    try:
        for path, writer in files:
            if make_folders:
                path.parent.mkdir(parents=True, exist_ok=True)
            staged.append(_new_file(path))
            writer(staged[-1])
            _flush(staged[-1])
        for path, new in zip(paths, staged, strict=True):
            _move(new, path, overwrite)
    finally:
        for new in staged:
            new.unlink(missing_ok=True)
    return paths


def text_writer(text: str, encoding: str = "utf-8") -> Writer:
    """A writer of this text."""
    return lambda path: _write_bytes(path, text.encode(encoding))


def _write_bytes(path: Path, content: bytes) -> None:
    path.write_bytes(content)


def _check_folder(folder: Path) -> None:
    """The nearest folder that is there must be one, and take files."""
    there = folder
    while not os.path.lexists(there) and there != there.parent:
        there = there.parent
    if not there.is_dir():
        raise CommandError(f"{there} is not a folder.")
    if not os.access(there, os.W_OK | os.X_OK):
        raise CommandError(f"{there} may not be written to.")


def _new_file(path: Path) -> Path:
    """An empty file beside `path`, made by this call, with the rights of any new file."""
    try:
        handle, name = tempfile.mkstemp(prefix=".rattle-", suffix=".new", dir=path.parent)
    except OSError as fault:
        raise CommandError(f"{path}: {fault.strerror or fault}.") from None
    os.close(handle)
    mask = os.umask(0)
    os.umask(mask)
    os.chmod(name, 0o666 & ~mask)
    return Path(name)


def _flush(path: Path) -> None:
    with path.open("rb") as stream:
        os.fsync(stream.fileno())


def _move(new: Path, path: Path, overwrite: bool) -> None:
    """Give a whole file its name; one that came in the meantime is replaced only if that was asked for."""
    if overwrite:
        os.replace(new, path)
        return
    try:
        os.link(new, path)
    except FileExistsError:
        raise CommandError(f"{path} was written by another program in the meantime; it is kept.") from None
    except OSError as fault:
        if fault.errno not in NO_LINKS:
            raise
        check([path], overwrite=False)
        os.replace(new, path)
