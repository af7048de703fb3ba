"""What a picture of 1280 x 720 takes on a software renderer with everything on, idle and beside a solver.

The flood plays on while the camera flies round the map: ground with contour lines and edit marks, natural
water blended between two frames, sky, walls of the map, a draped levee and all panels. The scale of the
scene follows the pictures as it does in the window. Each picture is waited for. The solver computes the same
flood over and over in another process on all cores.
"""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np

from bench.viewer_scenes import SIZE, Scene, scenes
from viewer.app.picture_pace import SCALES, PicturePace
from viewer.app.picture_quality import SOFTWARE_SCALE, interactive, is_software
from viewer.render import (
    DrapedLine,
    EditOverlay,
    FrameInputs,
    HudText,
    LineStyle,
    Renderer,
    RenderOptions,
    WaterFrame,
    WaterPair,
    create_headless_context,
)

WARM_UP = 60
PICTURES = 240
BUDGET_MS = 100.0
LEAST_RATE = 5.0
"""Pictures a second beside a solver."""


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """Times of pictures alone and beside a solver, for each scene."""
    ctx = create_headless_context()
    for scene in scenes(smoke):
        if scene.name == "srtm_2113":
            continue  # Four million cells are for a graphics card.
        for beside_solver in (False, True):
            yield _played(ctx, scene, beside_solver, 0.1 if smoke else 1.0)
    ctx.release()


def _played(ctx: moderngl.Context, scene: Scene, beside_solver: bool, share: float) -> dict[str, object]:
    renderer = Renderer(ctx, scene.field)
    framebuffer = ctx.simple_framebuffer(SIZE)
    pace = PicturePace(SOFTWARE_SCALE if is_software(ctx) else 1.0)
    warm_up, pictures = round(share * WARM_UP), round(share * PICTURES)
    solver = multiprocessing.get_context("spawn").Process(target=_compute_for_ever, daemon=True)
    if beside_solver:
        solver.start()
        time.sleep(5.0 * share)
    times, cpu_s = [], 0.0
    for k, inputs in enumerate(_flown(scene, warm_up + pictures)):
        begun = time.perf_counter()
        options = interactive(inputs.options, pace.scale) if is_software(ctx) else inputs.options
        renderer.draw(framebuffer, SIZE, replace(inputs, options=options))
        ctx.finish()
        times.append(1e3 * (time.perf_counter() - begun))
        pace.note(times[-1])
        if k == warm_up:
            times, cpu_s = [], time.process_time()
    cpu_ms = 1e3 * (time.process_time() - cpu_s) / len(times)
    if beside_solver:
        solver.kill()
        solver.join()
    ctx.detect_framebuffer(0).use()
    renderer.release()
    framebuffer.release()
    p95 = round(float(np.percentile(times, 95.0)), 1)
    rate = round(1e3 * len(times) / sum(times), 1)
    return {
        "figure": "pictures_per_second" if beside_solver else "picture_time_p95",
        "value": rate if beside_solver else p95,
        "unit": "1/s" if beside_solver else "ms",
        "wanted": f">= {LEAST_RATE:g}" if beside_solver else f"<= {BUDGET_MS:g}",
        "scene": scene.name,
        "cells": list(scene.field.z_b.shape),
        "solver": "computing" if beside_solver else "idle",
        "median_ms": round(float(np.median(times)), 1),
        "p95_ms": p95,
        "largest_ms": round(max(times), 1),
        "pictures": len(times),
        "cpu_ms": round(cpu_ms, 1),
        "render_scale": pace.scale,
        "finest_scale": SCALES[0],
        "renderer": str(ctx.info["GL_RENDERER"]),
    }


def _flown(scene: Scene, pictures: int) -> Iterator[FrameInputs]:
    """Pictures of a flight: a new pair of frames every fifth picture, a little farther in between."""
    shape = scene.field.z_b.shape
    sign = np.zeros(shape, np.int8)
    row, width = shape[0] // 2, shape[1]
    sign[row : row + 3, width // 4 : width // 2] = 1
    grid = scene.field.grid
    ends = tuple(grid.center(row, col) for col in (width // 4, width // 2))
    edits = EditOverlay(1, sign, (DrapedLine(ends, 3.0 * grid.dx, LineStyle.RAISE),))
    hud = HudText("Flood", "01:23:45", "run, branch\n40 x real time", is_hypothetical=True)
    options = RenderOptions(contour_interval=10.0)
    flight = [scene.camera(), *scene.flight(pictures - 1)]
    frames = [WaterFrame(("played", k), h) for k, h in enumerate(scene.waters)]
    for k, camera in enumerate(flight):
        at = k // 5
        pair = WaterPair(frames[at % len(frames)], frames[(at + 1) % len(frames)], 0.2 * (k % 5))
        yield FrameInputs(camera, pair, edits, options, hud)


def _compute_for_ever() -> None:
    from solver_service.numerics import ShallowWaterSolver
    from solver_service.scenario import load_case

    case = load_case("jacksboro")
    while True:
        solver = ShallowWaterSolver(case.model, case.params)
        solver.set_water(case.initial_h)
        solver.advance_to(case.duration)
