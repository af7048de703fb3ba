import json
from pathlib import Path

from viewer.app.summary import FlightSummary, table_text, write_summary


def summary() -> FlightSummary:
    return FlightSummary(
        case="jacksboro",
        title="A dam break",
        hypothetical=True,
        device="cpu",
        cells=547_479,
        cell_size_m=30.0,
        steps=7856,
        sim_time_s=3600.0,
        wall_s=18.4,
        speed_x_real_time=196.0,
        volume_error_relative=5.5e-8,
        recalculate_latency_s=0.6,
        recalculate_next_frame_s=0.9,
        first_picture_s=9.9,
        changed_share=0.07,
        total_wall_s=41.6,
        pictures=["a.png", "b.png"],
    )


def test_the_table_says_what_a_manager_asks_first() -> None:
    text = table_text(summary())

    assert "547,479 of 30 m on cpu" in text
    assert "01:00:00 in 18.4 s, 196 x real time" in text
    assert "5.5e-08" in text
    assert "first changed frame after 0.60 s, the next after 0.90 s" in text
    assert "7.0 % of the pixels" in text


def test_what_is_not_known_is_left_out_of_the_table() -> None:
    text = table_text(FlightSummary(case="a"))

    assert "None" not in text
    assert "steps" not in text


def test_the_file_holds_every_figure(tmp_path: Path) -> None:
    write_summary(summary(), tmp_path / "summary.json")
    read = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))

    assert read["recalculate_latency_s"] == 0.6
    assert read["pictures"] == ["a.png", "b.png"]
    assert set(read) == set(FlightSummary.__dataclass_fields__)
    assert not list(tmp_path.glob("*.part"))
