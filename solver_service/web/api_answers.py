"""OpenAPI of the service: what each route answers, refuses and needs, from the types that it answers with."""

from __future__ import annotations

import re
from typing import Any

import msgspec
from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.openapi.utils import get_openapi
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException

from solver_service.web import api_examples
from solver_service.web.api_types import Problem
from solver_service.web.scopes import Scope

REFERENCE = "#/components/schemas/{name}"
SCHEME = "token"
CODES = {400: "invalid_request", 401: "wrong_token", 404: "not_found", 405: "not_allowed"}
ABOUT = (
    "Runs of floods, by REST for scripts and operators; viewers use the stream, a websocket at /v1/stream. "
    "A token is shown in the Authorization header, never in the address."
)
_kinds: dict[str, Any] = {"Problem": Problem}

Answers = dict[int | str, dict[str, Any]]


def answers(kind: Any, example: Any, *refusals: int, status: int = 200) -> Answers:
    """The `responses` of a route that answers JSON; its `response_model` is to be None.

    Args:
        kind: the type of the answer; None for an answer without content.
        example: an answer.
        refusals: statuses of refusals beside 401, 403 and 422, which come by themselves.
        status: status of the answer.
    """
    found: Answers = {status: {"description": "As asked"}, **problems(*refusals)}
    if kind is not None:
        _kinds[str(kind)] = kind
        (schema,), _ = msgspec.json.schema_components([kind], ref_template=REFERENCE)
        found[status]["content"] = {"application/json": {"schema": schema, "example": example}}
    return found


def text_answer(media_type: str, example: str, *refusals: int) -> Answers:
    """The `responses` of a route that answers text."""
    content = {media_type: {"schema": {"type": "string"}, "example": example}}
    return {200: {"description": "As asked", "content": content}, **problems(*refusals)}


def problems(*statuses: int) -> Answers:
    """Refusals, each with an example."""
    return {
        status: {
            "description": api_examples.PROBLEMS[status]["code"].replace("_", " ").capitalize(),
            "content": {
                "application/json": {
                    "schema": {"$ref": REFERENCE.format(name="Problem")},
                    "example": api_examples.PROBLEMS[status],
                }
            },
        }
        for status in statuses
    }


def describe(app: FastAPI) -> None:
    """Let an application tell the whole of itself at /openapi.json, and refuse in one form."""

    @app.exception_handler(HTTPException)
    def tell_refusal(request: Request, error: HTTPException) -> JSONResponse:
        problem = {"code": CODES.get(error.status_code, "refused"), "detail": str(error.detail)}
        headers = error.headers
        if error.status_code == 405:  # a router knows its own methods of an address only
            headers = {"Allow": ", ".join(_methods(app.openapi()["paths"], request.url.path))}
        return JSONResponse(problem, error.status_code, headers)

    @app.exception_handler(RequestValidationError)
    def tell_what_is_wrong(request: Request, error: RequestValidationError) -> JSONResponse:
        faults = (f"{' '.join(map(str, fault['loc']))}: {fault['msg']}" for fault in error.errors())
        return JSONResponse({"code": "invalid_request", "detail": "; ".join(faults)[:2000]}, 422)

    def whole() -> dict[str, Any]:
        if app.openapi_schema is None:
            app.openapi_schema = _schema(app)
        return app.openapi_schema

    app.openapi = whole  # type: ignore[method-assign]


def _schema(app: FastAPI) -> dict[str, Any]:
    schema = get_openapi(title=app.title, version=app.version, description=ABOUT, routes=app.routes)
    for operations in schema["paths"].values():
        for operation in operations.values():
            _complete(operation)
    _, components = msgspec.json.schema_components(_kinds.values(), ref_template=REFERENCE)
    kinds = schema.setdefault("components", {}).setdefault("schemas", {})
    kinds.update(_with_plain_patterns(components))
    for name in ("HTTPValidationError", "ValidationError"):
        kinds.pop(name, None)
    return schema


def _methods(paths: dict[str, Any], asked: str) -> list[str]:
    """The methods of an address."""
    return sorted(
        {
            method.upper()
            for path, operations in paths.items()
            if re.fullmatch(re.sub(r"\{[^}]+\}", "[^/]+", path), asked)
            for method in operations
        }
    )


def _complete(operation: dict[str, Any]) -> None:
    """Give an operation its summary, the scope it needs and the refusals that every route shares."""
    words = operation.get("description", "")
    operation["summary"] = words.partition("\n")[0].rstrip(".")
    answered = operation["responses"]
    shared = [422] if "422" in answered else []
    for scope in (name for scheme in operation.get("security", ()) for name in scheme[SCHEME]):
        operation["description"] = f"{words}\n\nNeeds the scope {scope}."
        shared += [401] if scope == str(Scope.VIEWER) else [401, 403]
    answered.update({str(status): answer for status, answer in problems(*shared).items()})


def _with_plain_patterns(schema: Any) -> Any:
    r"""The same schema with patterns that JSON Schema knows: it has no `\Z`, and needs none."""
    if isinstance(schema, dict):
        return {
            key: value.replace("\\Z", "$") if key == "pattern" else _with_plain_patterns(value)
            for key, value in schema.items()
        }
    return [_with_plain_patterns(each) for each in schema] if isinstance(schema, list) else schema
