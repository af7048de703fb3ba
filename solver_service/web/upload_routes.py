"""REST of uploads: a case comes in as a zip, is watched, and can be removed again."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, HTTPException, Path, Request

from solver_service.errors import CaseError
from solver_service.uploads.upload_desk import Sender, UploadDesk
from solver_service.uploads.upload_record import UploadRecord
from solver_service.web.api_answers import answers
from solver_service.web.api_examples import UPLOAD
from solver_service.web.auth import Access
from solver_service.web.quotas import Quotas, owner_of
from solver_service.web.scopes import Scope

UPLOAD_ID = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", examples=["u0123456789ab"])]
CASE_NAME = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{1,64}$", examples=["river"])]

BODY = {
    "requestBody": {
        "required": True,
        "description": "The archive: a zip of the folder of a case (.fevcase).",
        "content": {
            "application/zip": {
                "schema": {"type": "string", "format": "binary"},
                "example": "PK (the bytes of river.fevcase)",
            }
        },
    }
}


def upload_router(desk: UploadDesk, quotas: Quotas, needs: Callable[[Scope], Any]) -> APIRouter:
    """The routes of uploads.

    Args:
        desk: takes the uploads in.
        quotas: how much the holder of a token may take.
        needs: makes the dependency that lets a scope pass.
    """
    router = APIRouter(tags=["uploads"])
    controller = needs(Scope.CONTROLLER)

    @router.post(
        "/v1/uploads",
        status_code=202,
        openapi_extra=BODY,
        response_model=None,
        responses=answers(UploadRecord, UPLOAD, 409, 413, 422, 429, 507, status=202),
    )
    async def upload_case(request: Request, access: Access = controller) -> dict[str, Any]:
        """Upload a case; the answer comes when all of it has come, and its import goes on."""
        size = _declared_size(request)
        if size == 0:
            raise CaseError("the archive has 0 bytes; a zip of the folder of a case is allowed")
        sender = Sender(owner_of(access), access.label, lambda size: quotas.disk(access, size))
        record = await desk.receive(request.stream(), size, sender)
        return record.facts()

    @router.get(
        "/v1/uploads",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(list[UploadRecord], [UPLOAD]),
    )
    async def uploads() -> list[dict[str, Any]]:
        """The uploads under way and the latest that have ended, newest first."""
        return [record.facts() for record in desk.uploads]

    @router.get(
        "/v1/uploads/{upload}",
        dependencies=[needs(Scope.VIEWER)],
        response_model=None,
        responses=answers(UploadRecord, UPLOAD, 404),
    )
    async def upload_status(upload: UPLOAD_ID) -> dict[str, Any]:
        """Where an upload stands; once it has ended, the case or why it was refused."""
        record = desk.upload(upload)
        if record is None:
            raise HTTPException(404, f"there is no upload {upload!r}")
        return record.facts()

    @router.delete(
        "/v1/cases/{case}",
        dependencies=[needs(Scope.OPERATOR)],
        status_code=204,
        responses=answers(None, None, 409, status=204),
    )
    async def remove_case(case: CASE_NAME) -> None:
        """Remove an uploaded case; refused while runs are of it."""
        await desk.remove(case)

    return router


def _declared_size(request: Request) -> int | None:
    """What the Content-Length says, if anything."""
    text = request.headers.get("content-length", "")
    return int(text) if text.isdecimal() else None
