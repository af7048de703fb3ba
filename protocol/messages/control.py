"""Who controls a run: one connection at a time may change it, all others follow."""

from __future__ import annotations

from protocol.fields import Command, Identifier, Message, Name


class TakeControl(Command, frozen=True):
    """Become the controller of a run.

    Granted when nobody controls it or its controller has sent no command for 30 s. Refused otherwise, and
    the controller gets `control_requested`; unless `force` is set, which is granted always. A command that
    changes a run which nobody controls takes control by itself.

    Attributes:
        run: id of the run.
        force: whether to take it from a controller that is active.
    """

    run: Identifier
    force: bool = False


class ReleaseControl(Command, frozen=True):
    """Give up the control of a run; the end of the connection does the same for all its runs.

    Attributes:
        run: id of the run.
        to: id of the session that controls it from now on, or none for nobody.
    """

    run: Identifier
    to: Identifier | None = None


class ControlChanged(Message, frozen=True):
    """A watched run has another controller, or none; also follows the `ack` of `subscribe`.

    Attributes:
        run: id of the run.
        session: id of the session that controls it (compare `welcome`), or none.
        client: name of its client program.
    """

    run: Identifier
    session: Identifier | None = None
    client: Name = ""


class ControlRequested(Message, frozen=True):
    """Told to the controller of a run: somebody else asked for the control and was refused.

    Attributes:
        run: id of the run.
        session: id of the session that asked, for `release_control`.
        client: name of its client program.
    """

    run: Identifier
    session: Identifier
    client: Name = ""
