"""Write the kept figures of the bench into the page: `python -m bench.peers.table`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
RESULTS = ROOT / "bench" / "results" / "peers.json"
PAGE = ROOT / "docs" / "explanation" / "peers.md"
BEGIN, END = "<!-- figures: written by bench.peers.table -->", "<!-- figures end -->"


def row(line: dict[str, Any], titles: list[str]) -> str:
    """One solver's line of the table."""
    if "skipped" in line:
        return f"| {line['figure']} | skipped: {line['skipped']} |" + " |" * (5 + len(titles))
    errors = [f"{1000.0 * line['errors'][title]['error_h_m']:.1f}" for title in titles]
    cells = [
        f"{line['figure']} ({line['version']})",
        line["scheme"],
        f"{line['value']:.1f}",
        f"{line['steps']}",
        f"{line['cpu_s']:.1f}",
        f"{line['wall_s']:.1f}",
        *errors,
        f"{line['volume_error_relative']:.0e}",
    ]
    return "| " + " | ".join(cells) + " |"


def render(lines: list[dict[str, Any]]) -> str:
    """The table, and how far the references are apart, as Markdown."""
    solvers = [line for line in lines if "errors" in line or "skipped" in line]
    titles = list(next((line["errors"] for line in solvers if "errors" in line), {}))
    columns = ["solver", "scheme", "M cell-steps/CPU s", "steps", "CPU s", "wall s"]
    columns += [f"error of h against {title} [mm]" for title in titles]
    columns.append("volume error")
    text = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    text += [row(line, titles) for line in solvers]
    machine = lines[0]["machine"]
    text += ["", f"{lines[0]['date']}, {machine['cpu']}, {machine['system']}, commit {machine['commit']}."]
    for line in lines:
        if line.get("unit") == "m":
            text.append(f"{line['figure']}: {1000.0 * line['value']:.1f} mm on average.")
    return "\n".join(text)


def main() -> None:
    """Rewrite what stands between the marks of the page."""
    before, rest = PAGE.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    lines = json.loads(RESULTS.read_text(encoding="utf-8"))
    PAGE.write_text(f"{before}{BEGIN}\n\n{render(lines)}\n\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
