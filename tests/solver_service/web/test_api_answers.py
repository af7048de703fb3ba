"""/openapi.json of a real service tells every route whole, and what it tells is so."""

import copy
from typing import Any

import httpx
import pytest

from bench.service_process import ServiceProcess
from tests.solver_service.web.test_token_watch import PUBLIC, ROUTES

Schema = dict[str, Any]


@pytest.fixture(scope="module")
def schema(service: ServiceProcess) -> Schema:
    found: Schema = httpx.get(f"{service.http}/openapi.json", timeout=30.0).json()
    return found


def operations(schema: Schema) -> dict[tuple[str, str], Schema]:
    return {
        (method, path): told for path, methods in schema["paths"].items() for method, told in methods.items()
    }


def lacks(schema: Schema) -> list[str]:
    """What somebody who reads the description would miss."""
    missing = []
    for (method, path), told in operations(schema).items():
        where = f"{method} {path}"
        if not told.get("summary") or told["summary"].replace(" ", "_").lower() == path.rpartition("/")[2]:
            missing.append(f"{where}: summary")
        if len(told.get("description", "")) <= len(told.get("summary", "")):
            missing.append(f"{where}: description")
        for status, answer in told["responses"].items():
            content = answer.get("content", {})
            if status != "204" and not content:
                missing.append(f"{where}: content of {status}")
            missing += [f"{where}: example of {status}" for each in content.values() if "example" not in each]
            missing += [f"{where}: schema of {status}" for each in content.values() if not each.get("schema")]
        for parameter in told.get("parameters", ()):
            if not ({"example", "examples"} & (parameter.keys() | parameter["schema"].keys())):
                missing.append(f"{where}: example of {parameter['name']}")
        for body in told.get("requestBody", {}).get("content", {}).values():
            target = body["schema"]
            if "$ref" in target:
                target = schema["components"]["schemas"][target["$ref"].rpartition("/")[2]]
            if not ({"example", "examples"} & (body.keys() | target.keys())):
                missing.append(f"{where}: example of the body")
    return missing


def test_every_route_has_words_types_refusals_and_examples(schema: Schema) -> None:
    assert {(method, path) for method, path in operations(schema)} == PUBLIC | set(ROUTES)
    assert lacks(schema) == []


@pytest.mark.parametrize(
    ("path", "method", "key", "told"),
    [
        ("/v1/runs", "get", ("responses", "200", "content", "application/json", "example"), "example of 200"),
        ("/v1/runs/{run}", "get", ("responses", "404", "content"), "content of 404"),
        ("/v1/runs/{run}", "get", ("parameters",), None),
        ("/v1/runs", "post", ("summary",), "summary"),
    ],
)
def test_a_route_without_an_example_is_noticed(
    schema: Schema, path: str, method: str, key: tuple[str, ...], told: str | None
) -> None:
    poorer = copy.deepcopy(schema)
    place = poorer["paths"][path][method]
    for name in key[:-1]:
        place = place[name]
    del place[key[-1]]
    assert lacks(poorer) == ([] if told is None else [f"{method} {path}: {told}"])


def test_every_route_but_the_public_ones_tells_that_it_needs_a_token_and_its_scope(schema: Schema) -> None:
    for key, told in operations(schema).items():
        if key in PUBLIC:
            assert "security" not in told
            assert "401" not in told["responses"]
        else:
            assert told["security"] == [{"token": [str(ROUTES[key])]}]
            assert f"Needs the scope {ROUTES[key]}." in told["description"]
            assert "401" in told["responses"]
    assert schema["components"]["securitySchemes"]["token"] == {"type": "http", "scheme": "bearer"}


def test_refusals_have_one_form(service: ServiceProcess) -> None:
    headers = {"Authorization": f"Bearer {service.token}"}
    with httpx.Client(base_url=service.http, headers=headers) as client:
        answers = [
            client.get("/v1/runs/none"),
            client.get("/nowhere"),
            client.put("/v1/runs"),
            client.post("/v1/runs", json={"case": 5}),
            client.post("/v1/runs", content=b"{"),
            client.post("/v1/runs", json={"case": "atlantis"}),
            httpx.get(f"{service.http}/v1/runs"),
        ]
    assert [answer.status_code for answer in answers] == [404, 404, 405, 422, 422, 409, 401]
    for answer in answers:
        assert set(answer.json()) == {"code", "detail"}
        assert isinstance(answer.json()["detail"], str)
    assert answers[2].headers["allow"] == "GET, POST"
    assert "body case" in answers[3].json()["detail"]
