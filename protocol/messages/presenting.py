"""A session shows its view to the others: where its camera is, which run and time are on its picture."""

from __future__ import annotations

from typing import Annotated

from msgspec import Meta

from protocol.fields import Command, Coordinate, Identifier, Message, Name, NotNegative, Positive, WireStruct

Degrees = Annotated[float, Meta(ge=-360, le=360)]


class View(WireStruct, frozen=True):
    """What is on a picture.

    Attributes:
        run: id of the run.
        time: simulated time [s].
        is_playing: whether the time runs on.
        speed: simulated seconds a second while it does.
        x: easting of the point looked at [m].
        y: northing of the point looked at [m].
        distance: from the eye to that point [m].
        azimuth: compass bearing in which the camera looks [degrees].
        elevation: height of the eye above the horizon [degrees].
    """

    run: Identifier
    time: NotNegative
    x: Coordinate
    y: Coordinate
    distance: Positive
    azimuth: Degrees
    elevation: Degrees
    is_playing: bool = False
    speed: Positive = 1.0


class PresentView(Command, frozen=True):
    """Show a view to all sessions, which may follow it; at most `MAX_VIEWS_PER_S` a second.

    Attributes:
        view: the view; none ends the presentation, as the end of the connection does.
    """

    view: View | None = None


class ViewPresented(Message, frozen=True):
    """A session presents its view; also told to every session after its `welcome`.

    Attributes:
        session: id of the session that presents.
        client: name of its client program.
        view: its view; none: the presentation is over.
    """

    session: Identifier
    client: Name = ""
    view: View | None = None
