"""`python -m bench NAME [--smoke] [--keep]`.

A bench is a module or package of this package with a function `figures(smoke)` that yields one dictionary per
figure, with at least `figure`, `value` and `unit`. `--smoke` takes a size that a continuous integration run
can afford.
"""

from __future__ import annotations

import argparse
import importlib
import json
import pkgutil
import sys
import time
from pathlib import Path

from bench.machine import load, machine

FOLDER = Path(__file__).parent
NOT_BENCHES = {
    "__init__",
    "__main__",
    "crowd",
    "cubin",
    "floods",
    "loop_lag",
    "machine",
    "service_process",
    "shaped_link",
    "slope",
    "slosh",
    "viewer_scenes",
}


def names() -> list[str]:
    """The benches there are."""
    return sorted({module.name for module in pkgutil.iter_modules([str(FOLDER)])} - NOT_BENCHES)


def main(arguments: list[str] | None = None) -> int:
    """Run one bench."""
    parser = argparse.ArgumentParser(prog="python -m bench", description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=names())
    parser.add_argument("--smoke", action="store_true", help="a small size, for continuous integration")
    parser.add_argument("--keep", action="store_true", help="keep the figures in bench/results/NAME.json")
    chosen = parser.parse_args(arguments)
    bench = importlib.import_module(f"bench.{chosen.name}")
    lines = []
    load_before = load()
    for figure in bench.figures(chosen.smoke):
        line = {
            "bench": chosen.name,
            "smoke": chosen.smoke,
            **figure,
            "load_before": load_before,
            "date": time.strftime("%Y-%m-%d", time.gmtime()),
            "machine": machine(),
        }
        lines.append(json.dumps(line))
        print(lines[-1], flush=True)
    if chosen.keep:
        results = FOLDER / "results"
        results.mkdir(exist_ok=True)
        (results / f"{chosen.name}.json").write_text("[\n" + ",\n".join(lines) + "\n]\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
