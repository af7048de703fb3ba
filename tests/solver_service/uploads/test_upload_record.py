import time

from solver_service.uploads.upload_record import UploadRecord


def test_an_upload_is_over_once_it_is_accepted_or_refused() -> None:
    record = UploadRecord("u1", "Ada", 100)
    assert not record.is_over
    record.accept("river", ("odd",))
    assert record.is_over
    assert (record.status, record.case, record.done) == ("accepted", "river", 1.0)
    refused = UploadRecord("u2", "Ada", None)
    refused.refuse("It is no case.")
    assert refused.is_over
    assert refused.facts()["message"] == "It is no case."
    assert abs(refused.facts()["ended"] - time.time()) < 5.0
