"""Writes docs/reliability.md from what scripts/reliability has found."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

KINDS = {
    ("once", "io"): "that call alone (input/output error)",
    ("onwards", "full"): "that call and all after it (disk full)",
    ("onwards", "denied"): "that call and all after it (permission denied, as in a folder that is read-only)",
    ("short", "full"): "half of what it writes arrives, and nothing after it (disk full in the middle of a row)",
}
HEAD = """# Reliability

What a run keeps when it is killed, when its disk fills up, and when its files are damaged: tried, not promised.
`scripts/reliability` writes this page (over an hour on two cores); a sample of each part is in `./test`.

What to do in each case is in the [user guide](user-guide.md#when-a-run-stops).
"""


def found_of(results: Path, part: str) -> dict[str, Any] | None:
    file = results / f"{part}.json"
    found: dict[str, Any] | None = json.loads(file.read_text()) if file.exists() else None
    return found


def findings_text(rows: list[dict[str, Any]]) -> str:
    findings = [finding for row in rows for finding in row["findings"]]
    if not findings:
        return ""
    lines = [f"- {finding}" for finding in findings[:20]]
    return "\nFindings:\n\n" + "\n".join(lines) + "\n"


def kills_text(found: dict[str, Any]) -> str:
    rows = found["rows"]
    lines = [
        f"| {row['subject']} | {row['seconds']:.0f} | {row['trials']} | {row['killed']} | {row['sound']} |"
        for row in rows
    ]
    trials, sound = sum(row["trials"] for row in rows), sum(row["sound"] for row in rows)
    return (
        "## Kills\n\n"
        "Each run is killed (SIGKILL) at a random moment of its time, from its first millisecond on, and then resumed\n"
        "(`thawslide resume`; run again where it was killed before it had read its case). Every file must be that of the\n"
        "run that nothing disturbed, byte for byte: history, probes, snapshots, index, maps, checkpoint. Only `run.json`,\n"
        "which tells of processes, may differ.\n\n"
        "| case | seconds a run | runs | killed before their end | ended with the same bytes |\n|---|---|---|---|---|\n"
        + "\n".join(lines)
        + f"\n\n{sound} of {trials} ended with the same bytes, without any repair by hand.\n"
        + findings_text(rows)
    )


def writes_text(found: dict[str, Any]) -> str:
    rows = found["rows"]
    lines = [
        f"| {row['subject']} | {KINDS[(row['kind'], row['reason'])]} | {row['trials']} of {row['calls']:,} |"
        f" {row['sound']} |"
        for row in rows
    ]
    return (
        "## Writing that fails\n\n"
        "Each call of a run that changes its folder (open, write, truncate, synchronise, rename, make a folder) is made\n"
        "to fail in turn; in 3D, where maps alone are thousands, every 41st. The run must end with an error that names the file, or go on where nothing is lost by it; then,\n"
        "with room again, it is resumed and must end with the bytes of the undisturbed run.\n\n"
        "| case | what fails | calls tried | sound |\n|---|---|---|---|\n"
        + "\n".join(lines)
        + "\n"
        + findings_text(rows)
    )


def corruption_text(found: dict[str, Any]) -> str:
    row = found["rows"][0]
    return (
        "## Damaged checkpoints\n\n"
        f"One bit of one byte is changed in both checkpoints of a run that was killed, at {row['changed']:,} places of\n"
        f"their {row['bytes']:,} bytes. Detected and refused: {row['detected']:,}. Where only the newer one is damaged the\n"
        "run goes on from the other (`tests/cli/resume_test.py`).\n" + findings_text(found["rows"])
    )


def soak_text(found: dict[str, Any]) -> str:
    row = found["rows"][0]
    same = "the same" if row["same_bits"] else "DIFFERENT"
    return (
        "## A million steps\n\n"
        f"A block of {row['particles']} particles on level ground, {row['steps']:,} steps, in two runs side by side\n"
        f"({row['wall_s']:.0f} s each).\n\n"
        "| what | after a tenth | at the end |\n|---|---|---|\n"
        f"| memory | {row['memory_after_a_tenth_kB'] / 1024:.1f} MB | {row['memory_at_the_end_kB'] / 1024:.1f} MB |\n"
        f"| strain energy | {row['strain_after_a_tenth_J']:.6g} J | {row['strain_at_the_end_J']:.6g} J |\n\n"
        f"Kinetic energy: {row['largest_kinetic_J']:.3g} J at most, {row['kinetic_at_the_end_J']:.3g} J at the end;\n"
        f"residual of the mechanical account: {row['residual_J']:.3g} J at most. History and checkpoint of the two runs are\n"
        f"{same} bit for bit.\n"
    )


TEXTS = {"kills": kills_text, "writes": writes_text, "corruption": corruption_text, "soak": soak_text}


def write_page(results: Path, page: Path) -> None:
    """Write the page; a part that never ran says so."""
    parts = [HEAD]
    for name, text in TEXTS.items():
        found = found_of(results, name)
        parts.append(text(found) if found else f"## {name.capitalize()}\n\nThis part has not been run.\n")
    page.write_text("\n".join(parts))
