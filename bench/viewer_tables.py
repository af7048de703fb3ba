"""The evaluation of the FEV Frontend (2011, chapter 5), done again: its six tests and two series.

Triangles are those with an area, counted by the selection that draws them. Times are those of whole pictures
until the graphics library says that it is done: terrain alone, water alone, and everything with the water
moving on five times a second as in the paper. View-frustum culling is off but for its own series. Cameras
and data: `viewer_scenes`.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

import moderngl
import numpy as np
import numpy.typing as npt

from bench.viewer_scenes import (
    FLIGHT_DISTANCE,
    FLIGHT_PITCH_DEG,
    PAPER_SHARES,
    SIZE,
    Scene,
    scenes,
    wall_of_water,
)
from viewer.render import (
    FrameInputs,
    FrameStats,
    Renderer,
    RenderOptions,
    WaterFrame,
    WaterPair,
    create_headless_context,
)
from viewer.world import Camera

Raster = npt.NDArray[np.float32]

TAU_PX = 3.0
BLOCK_SIZES = {"malpasset": (33, 17), "srtm_1026": (33, 17)}
"""Vertices along a block where a scene is drawn with more than the usual 33."""
PICTURES = 3
WATER_RATE = 5.0
"""Waters a second [1/s]."""
SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)

PLAIN = RenderOptions(
    tau_px=TAU_PX,
    cull=False,
    quadtree=True,
    water_spacing_px=0.0,
    partial_spacing_px=0.0,
    show_skirt=False,
    show_sky=False,
)
TESTS: dict[str, tuple[RenderOptions, bool]] = {
    "1. terrain without LOD, no water": (replace(PLAIN, full_mesh=True), False),
    "2. terrain with LOD, no water": (PLAIN, False),
    "3. terrain without LOD, water at full resolution": (
        replace(PLAIN, full_mesh=True, classify_water=False),
        True,
    ),
    "4, 5. terrain with LOD, water at full resolution in tiles": (replace(PLAIN, classify_water=False), True),
    "6. terrain with LOD, water in tiles with wet block classification": (PLAIN, True),
}
"""The paper's tests; 4 and 5 are one here, since tiles of one level are drawn by one call anyway."""

CAMERA = "the whole map from the south, 38 degrees down, 1280 x 720 pixels"
FLIGHT = (
    f"round the map on an ellipse of half its size, looking along the way {FLIGHT_PITCH_DEG:g} degrees down,"
    f" {FLIGHT_DISTANCE:g} of the longer side from the point looked at"
)

PAPER_TRIANGLES = {
    "Malpasset": (917_885, 96_070, 1_853_726, 1_193_065, 368_862),
    "Sardis": (2_062_878, 258_903, 4_156_692, 2_517_448, 524_557),
    "RossBarnett": (7_856_529, 782_801, 15_692_054, 10_828_256, 5_124_584),
}
PAPER_MILLISECONDS = {
    "Malpasset": (11.7, 2.4, 25.2, 17.8, 6.0),
    "Sardis": (14.7, 2.5, 32.1, 20.3, 5.4),
    "RossBarnett": (29.8, 3.7, 72.7, 50.1, 25.6),
}
"""On a GTX 285 of 2009, overall."""


class Easel:
    """A renderer of one scene with its framebuffer."""

    def __init__(self, ctx: moderngl.Context, scene: Scene) -> None:
        self._ctx = ctx
        self._renderer = Renderer(ctx, scene.field)
        self._framebuffer = ctx.simple_framebuffer(SIZE)

    def draw(self, camera: Camera, water: WaterPair | None, options: RenderOptions) -> FrameStats:
        """Draw one picture and wait until it is done."""
        stats = self._renderer.draw(self._framebuffer, SIZE, FrameInputs(camera, water, options=options))
        self._ctx.finish()
        return stats

    def milliseconds(
        self, camera: Camera, waters: list[WaterPair | None], options: RenderOptions
    ) -> tuple[float, FrameStats]:
        """Least wall time of a picture once all is uploaded [ms], and what the leanest one drew and took."""
        self.draw(camera, waters[0], options)
        times, stats = [], []
        for k in range(PICTURES):
            begun = time.perf_counter()
            stats.append(self.draw(camera, waters[k % len(waters)], options))
            times.append(time.perf_counter() - begun)
        return 1e3 * min(times), min(stats, key=lambda one: one.selection_ms + one.submission_ms)

    def upload_milliseconds(self, camera: Camera, waters: list[WaterPair | None]) -> float:
        """What a new water adds to the first picture that shows it [ms]."""
        extra = []
        for water in (*waters, *waters):
            begun = time.perf_counter()
            self.draw(camera, water, PLAIN)
            first = time.perf_counter() - begun
            begun = time.perf_counter()
            self.draw(camera, water, PLAIN)
            extra.append(first - (time.perf_counter() - begun))
        return max(0.0, 1e3 * float(np.median(extra)))

    def close(self) -> None:
        """Give the memory back."""
        self._renderer.release()
        self._framebuffer.release()


def figures(smoke: bool) -> Iterator[dict[str, object]]:
    """The paper's Table 5.1, its coverage series (5.3) and its culling series (5.4)."""
    ctx = create_headless_context()
    for scene in scenes(smoke):
        easel = Easel(ctx, scene)
        for block_size in BLOCK_SIZES.get(scene.name, (33,)):
            yield from _six_tests(easel, scene, block_size)
            yield from _animated(easel, scene, block_size)
        yield from _coverage(easel, scene)
        yield from _culling(easel, scene)
        easel.close()
    ctx.release()


def _pair(key: object, h: Raster) -> WaterPair:
    frame = WaterFrame(("bench", key), h)
    return WaterPair(frame, frame)


def _six_tests(easel: Easel, scene: Scene, block_size: int) -> Iterator[dict[str, object]]:
    camera = scene.camera()
    for which in ("least", "most"):
        h = scene.least if which == "least" else scene.most
        waters: list[WaterPair | None] = [_pair((which, 0), h), _pair((which, 1), h.copy())]
        upload = easel.upload_milliseconds(camera, waters)
        triangles: list[int] = []
        for number, (name, (plain, has_water)) in enumerate(TESTS.items()):
            options = replace(plain, block_size=block_size)
            shown: list[WaterPair | None] = waters[:1] if has_water else [None]
            overall, stats = easel.milliseconds(camera, shown, options)
            terrain, _ = easel.milliseconds(camera, shown, replace(options, show_water=False))
            water_ms = 0.0
            if has_water:
                water_ms, _ = easel.milliseconds(camera, shown, replace(options, show_terrain=False))
                # Waters change five times a second whatever the rate of the pictures is.
                overall += upload * min(1.0, WATER_RATE * (overall + upload) / 1e3)
            triangles.append(stats.terrain_triangles + stats.water_triangles)
            paper = PAPER_TRIANGLES.get(scene.paper_name)
            yield {
                "figure": "triangles",
                "value": triangles[-1],
                "unit": "triangles",
                "scene": scene.name,
                "origin": scene.origin,
                "cells": list(h.shape),
                "water": which,
                "block_size": block_size,
                "camera": CAMERA,
                "wet_blocks": round(scene.wet_share(h), 4),
                "blocks_with_water": round(scene.water_share(h), 4),
                "test": name,
                "terrain_triangles": stats.terrain_triangles,
                "water_triangles": stats.water_triangles,
                "draws": stats.draws,
                "overall_ms": round(overall, 1),
                "terrain_ms": round(terrain, 1),
                "water_ms": round(water_ms, 1),
                "selection_ms": round(stats.selection_ms, 2),
                "submission_ms": round(stats.submission_ms, 2),
                "paper_triangles": None if paper is None else paper[number],
                "paper_overall_ms": None if paper is None else PAPER_MILLISECONDS[scene.paper_name][number],
            }
        about: dict[str, object] = {"block_size": block_size, "water": which}
        yield _cut("terrain_cut_by_lod", scene, triangles[0], triangles[1], **about)
        yield _cut("cut_by_wet_block_classification", scene, triangles[3], triangles[4], **about)


def _animated(easel: Easel, scene: Scene, block_size: int) -> Iterator[dict[str, object]]:
    """The cut by wet block classification while the water moves on.

    Over all its times, and over those at which no more blocks hold water than in the paper.
    """
    most = PAPER_SHARES.get(scene.paper_name, (0.0, 1.0))[1]
    for water, highest in (("all times", 1.0), ("times with at most the paper's share", most)):
        waters = [h for h in scene.waters if scene.water_share(h) <= highest]
        counts = {}
        for classify in (False, True):
            options = replace(PLAIN, block_size=block_size, classify_water=classify)
            stats = [easel.draw(scene.camera(), _pair(("at", id(h)), h), options) for h in waters]
            counts[classify] = sum(one.terrain_triangles + one.water_triangles for one in stats)
        about: dict[str, object] = {"block_size": block_size, "water": water, "times": len(waters)}
        yield _cut("cut_by_wet_block_classification", scene, counts[False], counts[True], **about)


def _coverage(easel: Easel, scene: Scene) -> Iterator[dict[str, object]]:
    camera = scene.camera()
    for share in SHARES:
        water = _pair(("wall", share), wall_of_water(scene.field, share))
        for test, classify in (("5", False), ("6", True)):
            options = replace(PLAIN, classify_water=classify)
            overall, stats = easel.milliseconds(camera, [water], options)
            yield {
                "figure": "triangles_by_coverage",
                "value": stats.terrain_triangles + stats.water_triangles,
                "unit": "triangles",
                "scene": scene.name,
                "coverage": share,
                "test": test,
                "terrain_triangles": stats.terrain_triangles,
                "water_triangles": stats.water_triangles,
                "overall_ms": round(overall, 1),
            }


def _culling(easel: Easel, scene: Scene) -> Iterator[dict[str, object]]:
    water = _pair("flight", scene.most)
    means = {}
    hidden = []
    for cull in (False, True):
        counts, times = [], []
        for camera in scene.flight():
            begun = time.perf_counter()
            stats = easel.draw(camera, water, replace(PLAIN, cull=cull))
            times.append(1e3 * (time.perf_counter() - begun))
            counts.append(stats.terrain_triangles + stats.water_triangles)
            if cull:
                hidden.append(
                    stats.culled_blocks / (stats.culled_blocks + stats.terrain_blocks + stats.covered_blocks)
                )
        means[cull] = round(float(np.mean(counts)))
        yield {
            "figure": "triangles_in_flight",
            "value": means[cull],
            "unit": "triangles",
            "scene": scene.name,
            "culling": cull,
            "median_ms": round(float(np.median(times)), 1),
        }
    culled = round(100.0 * float(np.mean(hidden)), 1)
    flight = {"water": "most", "blocks_culled": culled, "camera": FLIGHT}
    yield _cut("cut_by_culling", scene, means[False], means[True], **flight)


def _cut(figure: str, scene: Scene, before: int, after: int, **about: object) -> dict[str, object]:
    return {
        "figure": figure,
        "value": round(100.0 * (1.0 - after / before), 1),
        "unit": "%",
        "scene": scene.name,
        **about,
    }
