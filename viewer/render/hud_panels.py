"""The panels written on a picture, made with Pillow: text, legend, scale bar and north arrow, banners."""

from __future__ import annotations

import math
from functools import cache

from PIL import Image, ImageDraw, ImageFont

from viewer.units import METRIC, US, Units
from viewer.world.water_scales import ClassScale

__all__ = [
    "banner_panel",
    "depth_ramp_panel",
    "difference_panel",
    "divider_panel",
    "flow_panel",
    "legend_panel",
    "mark_panel",
    "natural_water_colour",
    "nice_length",
    "scale_panel",
    "text_panel",
]

_INK = (255, 255, 255, 255)
_SOFT_INK = (214, 222, 230, 255)
_PLATE = (14, 24, 34, 168)
_MARGIN = 12

NATURAL_RAMP_DEPTHS = {
    METRIC: (0.0, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0),
    US: (0.0, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0),
}
"""Depths marked on the ramp of natural water, in each unit of length."""


DIFFERENCES = (
    ("{} deeper and more", (158, 13, 107)),
    ("deeper, newly wet", (232, 148, 204)),
    ("shallower, spared", (179, 222, 128)),
    ("{} shallower and more", (46, 120, 18)),
)
"""Colours of a comparison between two runs; the length is `MUCH`."""
MUCH = 1.0
"""From this difference on the colour is full [m]."""


@cache
def _font(size: int) -> ImageFont.FreeTypeFont | ImageFont.ImageFont:
    return ImageFont.load_default(size)


def _plate(
    width: int, height: int, colour: tuple[int, int, int, int] = _PLATE
) -> tuple[Image.Image, ImageDraw.ImageDraw]:
    image = Image.new("RGBA", (width, height), (0, 0, 0, 0))
    draw = ImageDraw.Draw(image)
    draw.rounded_rectangle((0, 0, width - 1, height - 1), radius=8, fill=colour)
    return image, draw


def _extent(text: str, size: int) -> tuple[int, int]:
    left, top, right, bottom = _font(size).getbbox(text or " ")
    return math.ceil(right - min(left, 0)), math.ceil(bottom - min(top, 0))


def text_panel(title: str, time: str, detail: str, scale: float) -> Image.Image:
    """Title, a large time, and lines of detail."""
    rows = [(title, round(17 * scale), _SOFT_INK), (time, round(27 * scale), _INK)]
    rows += [(line, round(15 * scale), _SOFT_INK) for line in detail.split("\n")]
    rows = [row for row in rows if row[0]]
    margin, gap = round(_MARGIN * scale), round(5 * scale)
    sizes = [_extent(text, size) for text, size, _ in rows]
    width = max(w for w, _ in sizes) + 2 * margin
    height = sum(h for _, h in sizes) + gap * (len(rows) - 1) + 2 * margin
    image, draw = _plate(width, height)
    y = margin
    for (text, size, ink), (_, h) in zip(rows, sizes, strict=True):
        draw.text((margin, y), text, font=_font(size), fill=ink)
        y += h + gap
    return image


def natural_water_colour(depth: float) -> tuple[int, int, int]:
    """SRGB of water over light ground seen from above, by the formulas of `shaders/water.frag`."""
    ground, absorption = (0.60, 0.61, 0.42), (0.95, 0.38, 0.30)
    shallow, deep = (0.27, 0.48, 0.53), (0.06, 0.21, 0.37)
    darkness = 1.0 - math.exp(-0.22 * depth)
    veil = 1.0 - 0.38 * min(depth / 0.12, 1.0)
    colour = []
    for g, a, s, d in zip(ground, absorption, shallow, deep, strict=True):
        through = veil * math.exp(-0.75 * a * depth)
        colour.append(round(255.0 * (g * through + (s + (d - s) * darkness) * (1.0 - through))))
    return (colour[0], colour[1], colour[2])


def legend_panel(classes: ClassScale, scale: float) -> Image.Image:
    """The classes by which water is coloured."""
    labels, heading = classes.labels, classes.heading
    size, row = round(15 * scale), round(22 * scale)
    margin, box = round(_MARGIN * scale), round(26 * scale)
    width = max(
        _extent(heading, size)[0], box + round(10 * scale) + max(_extent(text, size)[0] for text in labels)
    )
    image, draw = _plate(width + 2 * margin, row * (len(labels) + 1) + 2 * margin)
    draw.text((margin, margin), heading, font=_font(size), fill=_INK)
    # Deep on top, as water stands.
    for k, (text, colour) in enumerate(
        zip(reversed(labels), reversed(classes.colours), strict=True), start=1
    ):
        y = margin + k * row
        draw.rectangle((margin, y + 2, margin + box, y + row - 3), fill=(*colour, 255))
        draw.text((margin + box + round(10 * scale), y), text, font=_font(size), fill=_SOFT_INK)
    return image


def depth_ramp_panel(scale: float, units: Units = METRIC) -> Image.Image:
    """What natural water of different depths looks like from above."""
    depths = NATURAL_RAMP_DEPTHS[units]
    size, margin = round(15 * scale), round(_MARGIN * scale)
    step, bar = round(38 * scale), round(14 * scale)
    parts = len(depths) - 1
    image, draw = _plate(step * parts + 2 * margin, round(66 * scale) + margin)
    draw.text((margin, round(8 * scale)), f"Water depth [{units.length}]", font=_font(size), fill=_INK)
    y = round(34 * scale)
    for pixel in range(step * parts):
        part, share = divmod(pixel / step, 1.0)
        low, high = depths[int(part)], depths[int(part) + 1]
        colour = natural_water_colour(units.metres(low + share * (high - low)))
        draw.line((margin + pixel, y, margin + pixel, y + bar), fill=(*colour, 255))
    for part, depth in enumerate(depths):
        x = margin + part * step
        draw.line((x, y, x, y + bar + round(3 * scale)), fill=_SOFT_INK)
        place = (x, y + bar + round(5 * scale))
        draw.text(place, f"{depth:g}", font=_font(round(13 * scale)), fill=_SOFT_INK, anchor="mt")
    return image


def difference_panel(other: str, scale: float, units: Units = METRIC) -> Image.Image:
    """What the colours of a comparison mean, as `shaders/common/difference.glsl` has them."""
    size, row = round(15 * scale), round(22 * scale)
    margin, box, gap = round(_MARGIN * scale), round(26 * scale), round(10 * scale)
    much = f"{units.shown(MUCH):.2g} {units.length}"
    rows = [(text.format(much), colour) for text, colour in DIFFERENCES]
    heading = f"Against {other}"
    width = max(_extent(heading, size)[0], box + gap + max(_extent(text, size)[0] for text, _ in rows))
    image, draw = _plate(width + 2 * margin, row * (len(rows) + 1) + 2 * margin)
    draw.text((margin, margin), heading, font=_font(size), fill=_INK)
    for k, (text, colour) in enumerate(rows, start=1):
        y = margin + k * row
        draw.rectangle((margin, y + 2, margin + box, y + row - 3), fill=(*colour, 255))
        draw.text((margin + box + gap, y), text, font=_font(size), fill=_SOFT_INK)
    return image


def divider_panel(width: int, height: int) -> Image.Image:
    """The line between two runs."""
    return Image.new("RGBA", (width, height), (255, 255, 255, 255))


def flow_panel(speed: str, length: float, scale: float) -> Image.Image:
    """An arrow as long as one of that speed is on the picture, seen from above."""
    size, margin = round(15 * scale), round(_MARGIN * scale)
    text = f"Flow: {speed}"
    gap, height = round(12 * scale), round(22 * scale) + margin
    image, draw = _plate(round(length) + gap + _extent(text, size)[0] + 2 * margin, height)
    x, y, end, half = margin, height / 2, margin + length, 5.0 * scale
    draw.line((x, y, end - half, y), fill=_INK, width=max(2, round(3 * scale)))
    draw.polygon([(end, y), (end - 1.8 * half, y - half), (end - 1.8 * half, y + half)], fill=_INK)
    draw.text((end + gap, y), text, font=_font(size), fill=_INK, anchor="lm")
    return image


def mark_panel(name: str, is_chosen: bool, scale: float) -> Image.Image:
    """A pin whose point is the middle of the lower border, with its name above; an empty name has none."""
    ink = (255, 225, 90, 255) if is_chosen else (110, 245, 215, 255)
    size, pad, pin = round(14 * scale), round(5 * scale), round(15 * scale)
    head = max(2, round(5 * scale))
    width, height = (0, 0)
    if name:
        width, height = _extent(name, size)
        width, height = width + 2 * pad, height + 2 * pad
    plate = _plate(width, height)[0] if name else None
    full = max(width, 2 * head + 1) | 1  # odd, so that the point has a pixel
    image = Image.new("RGBA", (full, height + pin), (0, 0, 0, 0))
    if plate is not None:
        image.paste(plate, ((full - width) // 2, 0))
    draw = ImageDraw.Draw(image)
    if name:
        draw.text(((full - width) // 2 + pad, pad), name, font=_font(size), fill=ink)
    middle = full // 2
    draw.polygon(
        [(middle - head, height), (middle + head, height), (middle, height + pin - 1)],
        fill=ink,
        outline=(10, 20, 28, 255),
    )
    return image


def nice_length(longest: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above a length > 0."""
    power = 10.0 ** math.floor(math.log10(longest))
    return next(power * k for k in (5.0, 2.0, 1.0) if power * k <= longest * (1.0 + 1e-9))


def scale_panel(
    metres_per_pixel: float,
    bearing_deg: float,
    scale: float,
    units: Units = METRIC,
    contour_interval: float = 0.0,
) -> Image.Image:
    """A scale bar (true at the centre of the picture), what contour lines stand for, an arrow to the north.

    Args:
        metres_per_pixel: at the point that the camera looks at.
        bearing_deg: compass bearing of the view [degrees].
        scale: size of the panel, 1 for a picture 720 pixels high.
        units: units of the label.
        contour_interval: height between contour lines [m]; 0 for none.
    """
    margin, longest = round(_MARGIN * scale), 150.0 * scale
    reach = longest * metres_per_pixel
    unit, sign = (units.far, units.far_sign) if reach >= units.far else (units.metre, units.length)
    length = nice_length(reach / unit)
    pixels = round(length * unit / metres_per_pixel)
    label = f"{length:g} {sign}"
    if contour_interval > 0.0:
        label += f", contours every {contour_interval / units.metre:.3g} {units.length}"
    room = max(longest, _extent(label, round(15 * scale))[0])
    width, height = round(room + 70 * scale) + 2 * margin, round(58 * scale)
    image, draw = _plate(width, height)
    y = height - margin - round(4 * scale)
    draw.text((margin, margin - round(3 * scale)), label, font=_font(round(15 * scale)), fill=_INK)
    line = max(2, round(2 * scale))
    draw.line((margin, y, margin + pixels, y), fill=_INK, width=line)
    for x in (margin, margin + pixels):
        draw.line((x, y - round(5 * scale), x, y + round(3 * scale)), fill=_INK, width=line)

    centre_x, centre_y, r = width - margin - 18 * scale, height / 2, 19 * scale
    a = math.radians(-bearing_deg)

    def at(angle: float, radius: float) -> tuple[float, float]:
        return centre_x + radius * math.sin(a + angle), centre_y - radius * math.cos(a + angle)

    draw.polygon([at(0.0, r), at(2.6, r * 0.75), at(math.pi, r * 0.35)], fill=(235, 90, 70, 255))
    draw.polygon([at(0.0, r), at(-2.6, r * 0.75), at(math.pi, r * 0.35)], fill=(255, 190, 175, 255))
    draw.text((centre_x - 34 * scale, centre_y), "N", font=_font(round(15 * scale)), fill=_INK, anchor="lm")
    return image


def banner_panel(text: str, scale: float, alert: bool) -> Image.Image:
    """Lines that must not be overlooked: amber for a remark, red for an alert."""
    size, margin, gap = round(19 * scale), round(_MARGIN * scale), round(5 * scale)
    lines = text.split("\n")
    extents = [_extent(line, size) for line in lines]
    width = max(width for width, _ in extents)
    height = sum(height for _, height in extents) + gap * (len(lines) - 1)
    colour = (176, 32, 32, 232) if alert else (242, 176, 32, 236)
    image, draw = _plate(width + 2 * margin, height + round(1.2 * margin), colour)
    top = round(0.6 * margin)
    for line, (_, line_height) in zip(lines, extents, strict=True):
        draw.text((margin, top), line, font=_font(size), fill=_INK if alert else (30, 22, 0, 255))
        top += line_height + gap
    return image
