from PySide6.QtWidgets import QApplication

from viewer.gui.qt_start import XCB_LIBRARIES, missing_packages, start_qt


def test_a_library_that_is_not_there_is_named_by_its_package() -> None:
    assert missing_packages({"libnothing-of-the-kind.so.9": "libnothing9"}) == ["libnothing9"]


def test_this_machine_has_what_its_windows_need(qapp: QApplication) -> None:
    assert missing_packages() == []
    assert all(library.startswith("lib") and ".so" in library for library in XCB_LIBRARIES)


def test_a_running_application_is_used_again(qapp: QApplication) -> None:
    assert start_qt(["fev"]) is qapp
