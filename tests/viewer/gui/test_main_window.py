"""The real window under a virtual display, driven by mouse and keyboard."""

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from tests.viewer.gui.conftest import OpenWindow
from tests.viewer.tiny_service import FRAMES, INTERVAL, valley
from viewer.commands import BeginEdit, BeginMeasure, Seek


def picture(opened: OpenWindow) -> np.ndarray:
    image = opened.window.scene.grabFramebuffer().convertToFormat(QImage.Format.Format_RGB888)
    raw = np.frombuffer(image.constBits(), dtype=np.uint8)
    rows = raw.reshape(image.height(), image.bytesPerLine())[:, : 3 * image.width()]
    return rows.reshape(image.height(), image.width(), 3).copy()


def changed_share(before: np.ndarray, after: np.ndarray) -> float:
    return float(np.mean(np.abs(before.astype(int) - after.astype(int)).max(axis=2) > 24))


def test_the_flood_is_on_the_picture(opened: OpenWindow) -> None:
    opened.app.dispatch(Seek(0.0))
    opened.until(lambda: opened.app.is_settled)
    early = picture(opened)
    opened.app.dispatch(Seek(19 * INTERVAL))
    opened.until(lambda: opened.app.is_settled)

    assert len(np.unique(early.reshape(-1, 3), axis=0)) > 200
    assert changed_share(early, picture(opened)) > 0.01
    assert changed_share(early, early) == 0.0


def test_space_plays_and_pauses(opened: OpenWindow) -> None:
    opened.app.dispatch(Seek(0.0))
    opened.window.scene.setFocus()
    opened.bot.keyClick(opened.window.scene, Qt.Key.Key_Space)
    opened.until(lambda: opened.status.is_playing and opened.status.time > 0.0)
    opened.bot.keyClick(opened.window.scene, Qt.Key.Key_Space)

    opened.until(lambda: not opened.status.is_playing)


def test_the_play_button_does_the_same(opened: OpenWindow) -> None:
    opened.bot.mouseClick(opened.window.playback.play, Qt.MouseButton.LeftButton)
    opened.until(lambda: opened.status.is_playing)
    opened.until(lambda: opened.window.playback.play.text() == "Pause")


def test_a_levee_drawn_by_mouse_is_recalculated_and_changes_the_picture(opened: OpenWindow) -> None:
    app, window = opened.app, opened.window
    app.dispatch(Seek(10 * INTERVAL))
    opened.until(lambda: app.is_settled)
    window.edit_panel.line.trigger()
    opened.until(lambda: opened.status.is_drawing)
    opened.click(1400.0, 2250.0)
    opened.until(lambda: opened.status.drawn_vertices == 1)
    opened.bot.mouseMove(window.scene, opened.pixel_of(1400.0, 2400.0))
    opened.until(lambda: app.shown is not None and bool((app.shown.heightfield.z_b != valley()).any()))
    opened.click(1400.0, 2480.0)
    opened.until(lambda: opened.status.drawn_vertices == 2)
    window.scene.setFocus()
    opened.bot.keyClick(window.scene, Qt.Key.Key_Return)
    opened.until(lambda: len(opened.status.edits) == 1 and not app.is_busy)
    edit = app.shown.document.edits[0] if app.shown is not None else None
    assert edit is not None
    np.testing.assert_allclose(edit.vertices, [(1400.0, 2250.0), (1400.0, 2480.0)], atol=12.0)
    parent = app.shown.run if app.shown is not None else ""
    opened.until(lambda: window.edit_panel.recalculate_button.isEnabled())
    opened.bot.mouseClick(window.edit_panel.recalculate_button, Qt.MouseButton.LeftButton)
    opened.until(lambda: opened.status.shown_run != parent and not app.is_busy)
    opened.service.computed = FRAMES
    opened.until(lambda: app.shown is not None and len(app.shown.timeline) == FRAMES)
    app.dispatch(Seek(30 * INTERVAL))
    opened.until(lambda: app.is_settled)
    window.scene.repaint()
    with_levee = picture(opened)
    assert app.shown is not None
    app.control.select_run(parent)
    opened.until(
        lambda: app.shown is not None and app.shown.run == parent and len(app.shown.timeline) == FRAMES
    )
    app.dispatch(Seek(30 * INTERVAL))
    opened.until(lambda: app.is_settled)
    window.scene.repaint()

    assert changed_share(with_levee, picture(opened)) > 0.005
    assert opened.status.recalculate_latency_s is not None


def test_ctrl_z_and_ctrl_y_undo_and_redo(opened: OpenWindow) -> None:
    opened.window.edit_panel.line.trigger()
    opened.until(lambda: opened.status.is_drawing)
    opened.click(1400.0, 2250.0)
    opened.bot.wait(50)
    opened.click(1500.0, 2480.0)
    opened.until(lambda: opened.status.drawn_vertices == 2)
    opened.until(lambda: opened.window.edit_panel.finish.isEnabled())
    opened.window.edit_panel.finish.trigger()
    opened.until(lambda: len(opened.status.edits) == 1)
    opened.until(lambda: opened.window.edit_panel.undo.isEnabled())
    opened.bot.keyClick(opened.window.scene, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    opened.until(lambda: opened.status.edits == ())
    opened.until(lambda: opened.window.edit_panel.redo.isEnabled())
    opened.bot.keyClick(opened.window.scene, Qt.Key.Key_Y, Qt.KeyboardModifier.ControlModifier)

    opened.until(lambda: len(opened.status.edits) == 1)


def test_closing_the_window_ends_connection_and_decoding(opened: OpenWindow) -> None:
    opened.window.close()

    assert opened.app.desk.connection.state.phase == "closed"
    opened.until(lambda: not opened.service.connections)


def test_the_menu_reaches_every_view_option(opened: OpenWindow) -> None:
    texts = [
        action.text()
        for menu in opened.window.menuBar().actions()
        for action in menu.menu().actions()  # type: ignore[union-attr]
    ]

    assert {"Whole terrain", "From above", "Vertical exaggeration", "Contours", "Terrain error"} <= set(texts)
    assert {"Next water colours", "Wireframe", "Recalculate from now"} <= set(texts)
    assert [text.split()[0] for text in texts if text.startswith(("Undo", "Redo"))] == ["Undo", "Redo"]


def test_a_distance_is_measured_by_mouse_and_escape_ends_it(opened: OpenWindow) -> None:
    opened.bot.keyClick(opened.window, Qt.Key.Key_G)
    opened.until(lambda: opened.status.is_measuring)
    opened.until(lambda: opened.window.measure.isChecked())
    opened.click(1280.0, 2360.0)
    opened.click(1480.0, 2360.0)
    opened.until(lambda: " m, " in opened.window.status_line.message.text())
    assert opened.status.edit_tool == ""
    opened.bot.keyClick(opened.window.scene, Qt.Key.Key_Escape)
    opened.until(lambda: not opened.status.is_measuring)


def test_one_tool_is_in_the_hand(opened: OpenWindow) -> None:
    opened.app.dispatch(BeginEdit())
    opened.app.dispatch(BeginMeasure())
    assert (opened.status.edit_tool, opened.status.is_measuring) == ("", True)
    opened.app.dispatch(BeginEdit())

    assert (opened.status.edit_tool, opened.status.is_measuring) == ("line", False)
