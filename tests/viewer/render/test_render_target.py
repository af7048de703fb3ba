import moderngl
import numpy as np
import pytest

from viewer.render.render_target import RenderTarget

pytestmark = pytest.mark.gl


@pytest.mark.parametrize("samples", [0, 4])
def test_what_was_drawn_can_be_read(ctx: moderngl.Context, samples: int) -> None:
    target = RenderTarget(ctx, (16, 8), samples)
    target.framebuffer.use()
    target.framebuffer.clear(1.0, 0.0, 0.0, 1.0, depth=0.25)
    target.resolve()

    assert np.frombuffer(target.colour.read(), dtype=np.uint8)[:4].tolist() == [255, 0, 0, 255]
    assert target.depth_at(3, 3) == pytest.approx(0.25, abs=1e-6)
    assert np.frombuffer(target.read_depth(), dtype="<f4") == pytest.approx(np.full(128, 0.25), abs=1e-6)
    ctx.detect_framebuffer(0).use()
    target.release()
