from pathlib import Path

from solver_service.uploads.upload_rules import UploadRules
from solver_service.web import ServiceSettings


def test_the_settings_of_a_service_reach_its_uploads() -> None:
    settings = ServiceSettings(
        data_dir=Path(), upload_bytes=7, upload_cells=8, upload_memory_bytes=9, upload_time_s=10.0
    )
    rules = settings.upload_rules
    assert rules.archive_bytes == 7
    assert (rules.limits.cells, rules.limits.memory_bytes, rules.limits.time_s) == (8, 9, 10.0)
    assert rules.reserve_bytes == settings.reserve_bytes


def test_the_defaults_of_rules_and_settings_are_the_same() -> None:
    assert ServiceSettings(data_dir=Path()).upload_rules == UploadRules()
