"""Measures Edgesplat and VTK in turns on the views of a suite: `./dev bench peers`, docs/benchmarks.md."""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import time
from pathlib import Path

os.environ.setdefault("LP_NUM_THREADS", str(os.cpu_count() or 1))  # of the drivers on the processor, before they load

import numpy as np
from PIL import Image, ImageDraw

import edgesplat
from programs import THREADS, Edgesplat, Vtk, programs_for
from views import View, read_views

HERE = Path(__file__).resolve().parent
CAPTION = 16  # pixels
COLUMNS = ["view", "program", "least, ms", "median, ms", "processor, ms", "over Edgesplat", "first picture, ms"]
COLUMNS += ["opacity RMS", "colour, dB"]


class Measured:
    """Times and errors of one program on one view."""

    def __init__(self, make) -> None:
        begin = time.perf_counter()
        self.program = make()
        self.picture = self.program.draw()
        self.first = 1e3 * (time.perf_counter() - begin)
        self.wall: list[float] = []
        self.processor: list[float] = []
        self.errors = ["", ""]

    def turn(self) -> None:
        wall, processor = time.perf_counter(), time.process_time()
        self.picture = self.program.draw()
        self.wall.append(1e3 * (time.perf_counter() - wall))
        self.processor.append(1e3 * (time.process_time() - processor))

    def compare(self, truth: np.ndarray) -> None:
        opacity = np.sqrt(np.mean((self.program.opacity() - truth[..., 3]) ** 2))
        colour = np.sqrt(np.mean((np.clip(self.picture[..., :3], 0, 1) - truth[..., :3]) ** 2))
        self.errors = [f"{opacity:.4f}", f"{-20 * np.log10(max(colour, 1e-9)):.1f}"]


def truth_of(view: View) -> np.ndarray | None:
    """The exact picture; only builtin volumes have one."""
    if not view.source.startswith("builtin:"):
        return None
    exact = Edgesplat(view, output={"renderer": "truth"}, volume={"path": view.source})
    picture = exact.draw()
    exact.close()
    return picture


def measure(view: View, turns: int) -> tuple[dict[str, Measured], np.ndarray | None]:
    measured = {name: Measured(make) for name, make in programs_for(view).items()}
    order = list(measured.values())
    for done in measured.values():
        done.turn()  # may still prepare what later frames keep
        done.wall.clear()
        done.processor.clear()
    for turn in range(turns):
        for done in order[turn % len(order) :] + order[: turn % len(order)]:
            done.turn()
    truth = truth_of(view)
    if truth is not None:
        for done in measured.values():
            done.compare(truth)
    for done in measured.values():
        done.program.close()
    return measured, truth


def save_beside(path: Path, pictures: dict[str, np.ndarray]) -> None:
    """The pictures in a row, 8-bit sRGB, with their names."""
    width, height = next(iter(pictures.values())).shape[1::-1]
    sheet = Image.new("RGB", (width * len(pictures), height + CAPTION))
    draw = ImageDraw.Draw(sheet)
    for i, (name, linear) in enumerate(pictures.items()):
        light = np.clip(linear[..., :3], 0, 1)
        encoded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
        sheet.paste(Image.fromarray((255 * encoded + 0.5).astype(np.uint8)), (i * width, CAPTION))
        draw.text((i * width + 4, 2), name, fill="white")
    write(path, lambda new: sheet.save(new, "PNG"))


def write(path: Path, save) -> None:
    new = path.with_name(path.name + ".new")
    save(new)
    os.replace(new, path)


def brief(value: float) -> str:
    return f"{value:.0f}" if value >= 100 else f"{value:.1f}"


def rows_of(view: View, measured: dict[str, Measured], on_processor: bool) -> list[str]:
    """The rows of the table; the first program is the one that others are compared with."""
    ours, rows = next(iter(measured.values())), []
    for name, m in measured.items():
        times = map(brief, (min(m.wall), statistics.median(m.wall), statistics.median(m.processor)))
        turns = zip(m.processor, ours.processor) if on_processor else zip(m.wall, ours.wall)
        ratio = statistics.median(cost / our_cost for cost, our_cost in turns)
        first = view.name if m is ours else ""
        rows.append(f"| {' | '.join([first, name, *times, f'{ratio:.2f}', brief(m.first), *m.errors])} |")
    return rows


def main() -> None:
    parser = argparse.ArgumentParser(prog="./dev bench peers", description=__doc__)
    suite, output = HERE.parent / "standard.toml", Path("out/bench/peers")
    parser.add_argument("--suite", type=Path, default=suite, help="a suite of benchmarks (.toml)")
    parser.add_argument("-o", "--output", type=Path, default=output, help="folder for peers.md and pictures")
    parser.add_argument("--turns", type=int, default=3, help="frames that are timed of each program")
    parser.add_argument("cases", nargs="*", help="names of cases; default: all")
    asked = parser.parse_args()
    if asked.turns < 1:
        parser.error(f"--turns {asked.turns}: expected at least 1")
    if not asked.suite.is_file():
        parser.error(f"--suite {asked.suite}: no such file")
    asked.output.mkdir(parents=True, exist_ok=True)
    device = edgesplat.list_devices()[0]
    obstacle = Vtk.obstacle()
    lines = [
        f"Vulkan on {device.name} ({device.driver} {device.driver_version}); {obstacle or Vtk.about()}; "
        f"{THREADS} threads; {asked.turns} turns.",
        "",
        f"| {' | '.join(COLUMNS)} |",
        f"|---|---|{'--:|' * (len(COLUMNS) - 2)}",
    ]
    print("\n".join(lines), flush=True)
    for view in read_views(asked.suite, asked.cases):
        measured, truth = measure(view, asked.turns)
        pictures = {name: m.picture for name, m in measured.items()}
        save_beside(asked.output / f"{view.name}.png", pictures if truth is None else {**pictures, "truth": truth})
        rows = rows_of(view, measured, device.type == "cpu")
        print("\n".join(rows), flush=True)
        lines += rows
    write(asked.output / "peers.md", lambda new: new.write_text("\n".join(lines) + "\n"))
    if obstacle:
        print(f"VTK was not measured: {obstacle}", file=sys.stderr)


main()
