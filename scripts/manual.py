#!/usr/bin/env python3
"""Write the man page or the bash completion of the program, from its own --help and page of keys."""

from __future__ import annotations

import argparse
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

from rattle import command
from rattle.keys import Key, read_page

OPTION = re.compile(r"  (--[\w-]+)(?: (\[?[\w.=]+\]?))?  +(.*)")
FILES = (
    (".rattle", "result: columns with units behind a header that holds the resolved input"),
    (".summary.nml", "summary: what is reported of the run, as a namelist"),
    (".log", "log: the same as sentences"),
    (".state", "state at the end of a motion, from which --resume goes on"),
    (".progress.nml", "how far a campaign is"),
)

Keys = dict[tuple[str, str], Key]


def main() -> None:
    options = parse_options()
    help_text, page = (output_of(options.program, word) for word in ("--help", "--keys"))
    version = output_of(options.program, "--version").split()[-1]
    keys = read_page(page)
    write = {"man": man_page, "bash": completion}[options.form]
    print("\n".join(write(help_text, keys, version)))


def output_of(program: Path, word: str) -> str:
    ended = subprocess.run([program.resolve(), word], capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise command.CommandError(f"{program} {word} failed: {ended.stderr.strip()}")
    return ended.stdout


def man_page(help_text: str, keys: Keys, version: str) -> Iterator[str]:
    """The lines of rattle.1."""
    yield f'.TH RATTLE 1 "" "rattle {version}" "User Commands"'
    yield from (
        ".SH NAME",
        r"rattle \- lubricated gear rattle: transient oil film and tooth motion, solved and classified",
    )
    yield from (".SH SYNOPSIS", r".B rattle", escaped(help_text.splitlines()[0].partition(" ")[2]))
    yield ".SH DESCRIPTION"
    yield (
        "Solves what namelist files describe: the motion of a loose gear pair on its oil film, sweeps "
        "and campaigns of"
    )
    yield "motions, and the film itself. Says how the pair rattles and how far that can be trusted."
    yield ".SH OPTIONS"
    for option, value, words in options_of(help_text):
        yield from (
            ".TP",
            rf"\fB{escaped(option)}\fR" + (rf" \fI{escaped(value)}\fR" if value else ""),
            escaped(words),
        )
    yield ".SH INPUT KEYS"
    yield "SI units. In brackets: unit, default."
    yield "All keys and quantities with their tables:"
    yield r".I share/doc/rattle/keys.md ."
    group = ""
    for (owner, name), key in keys.items():
        if owner != group:
            group = owner
            yield f".SS &{group}"
        notes = ", ".join(word for word in (key.unit, key.default) if word not in ("", "-"))
        yield from (".TP", rf"\fB{escaped(name)}\fR" + (f" [{escaped(notes)}]" if notes else ""))
        needed = f" Used with {key.used_with}." if key.used_with else ""
        yield escaped(f"{key.meaning}{needed}".replace("`", ""))
    yield ".SH FILES"
    for ending, words in FILES:
        yield from (".TP", rf"\fINAME\fB{escaped(ending)}\fR", escaped(words))
    yield ".SH EXIT STATUS"
    yield escaped(" ".join(help_text.partition("exit code: ")[2].split()))
    yield from (".SH SEE ALSO", r".BR rattle-plot ,", r".BR rattle-report ,", r".BR rattle-campaign ,")
    yield from (
        r".BR rattle-compare ,",
        r".BR rattle-classify ,",
        r".BR rattle-export ;",
        r"each has its own \-\-help.",
    )


def completion(help_text: str, keys: Keys, version: str) -> Iterator[str]:
    """The lines of the bash completion."""
    options = " ".join(option for option, _, _ in options_of(help_text))
    templates = " ".join(dict.fromkeys(["gearbox", "motion", *(group for group, _ in keys)]))
    names = " ".join(f"{group}.{name}=" for group, name in keys)
    yield f"""# bash completion of rattle {version}
_rattle() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}}
    COMPREPLY=()
    compopt +o nospace
    case $before in
        --set)
            compopt -o nospace
            COMPREPLY=($(compgen -W '{names}' -- "$word"))
            return ;;
        --template)
            COMPREPLY=($(compgen -W '{templates}' -- "$word"))
            return ;;
        --output)
            compopt -o filenames
            COMPREPLY=($(compgen -d -- "$word"))
            return ;;
        --threads)
            return ;;
    esac
    case $word in
        -*) COMPREPLY=($(compgen -W '{options}' -- "$word")) ;;
        *)
            compopt -o filenames
            COMPREPLY=($(compgen -f -X '!*.nml' -- "$word") $(compgen -d -- "$word")) ;;
    esac
}}
complete -F _rattle rattle"""


def options_of(help_text: str) -> Iterator[tuple[str, str | None, str]]:
    """Name, value and meaning of each option that the help lists."""
    for line in help_text.splitlines():
        found = OPTION.fullmatch(line)
        if found:
            yield found[1], found[2], found[3]


def escaped(words: str) -> str:
    """Text that troff takes as it stands."""
    words = words.replace("\\", r"\e").replace("-", r"\-")
    return rf"\&{words}" if words.startswith((".", "'")) else words


def parse_options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        description="Write the man page or the bash completion of the program to standard output."
    )
    parser.add_argument("form", choices=("man", "bash"), help="what to write")
    parser.add_argument("program", type=Path, metavar="PROGRAM", help="the program, such as build/rattle")
    return command.parse(parser)


if __name__ == "__main__":
    command.run(main)
