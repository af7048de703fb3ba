"""One shows where the water goes, the others follow."""

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from tests.end_to_end.test_controllers import session_of, start_paused


def test_a_presented_view_reaches_all_others_also_those_who_come_later_and_ends_with_its_session(
    service: ServiceProcess, client: ServiceClient, case: str
) -> None:
    run = start_paused(client, case)
    view = protocol.View(run, 0.0, 10.0, 20.0, 300.0, 45.0, 30.0)
    with ServiceClient(service) as presenter:
        assert (
            "there is no run"
            in presenter.ask(
                protocol.PresentView, view=protocol.View("no-run", 0.0, 1.0, 1.0, 1.0, 0.0, 0.0)
            ).message
        )
        presenter.do(protocol.PresentView, view=view)
        told = client.first(protocol.ViewPresented)
        assert (told.session, told.view) == (session_of(presenter), view)
        with ServiceClient(service) as late:
            assert late.first(protocol.ViewPresented).view == view
    assert client.first(protocol.ViewPresented, lambda event: event.view is None).session == told.session
