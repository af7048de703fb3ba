"""An example of each answer of REST; the tests hold them against their types."""

from __future__ import annotations

from typing import Any

RUN = "r0123456789ab"
CASE: dict[str, Any] = {
    "name": "jacksboro",
    "title": "A dam break above Jacksboro",
    "hypothetical": True,
    "nrows": 344,
    "ncols": 403,
    "dx": 30.0,
    "duration": 3600.0,
    "output_interval": 30.0,
    "source": "USGS DEM",
    "licence": "public domain",
    "uploaded": False,
}
RUN_INFO: dict[str, Any] = {
    "run": RUN,
    "case": "jacksboro",
    "title": "A dam break above Jacksboro",
    "status": "running",
    "grid": {"nrows": 344, "ncols": 403, "dx": 30.0, "x0": 729000.0, "y0": 4015000.0, "crs": "EPSG:32616"},
    "duration": 3600.0,
    "output_interval": 30.0,
    "frame_count": 17,
    "device": "cuda:0",
    "hypothetical": True,
    "depth_wet": 0.001,
    "lineage": [{"run": RUN, "first_index": 0}],
}
TOKEN: dict[str, Any] = {
    "id": "1f0a2b3c",
    "label": "Ada, desk 3",
    "scope": "controller",
    "created": 1700000000.0,
    "expires": None,
    "revoked": None,
    "limits": {
        "max_runs": 20,
        "max_cells": None,
        "max_gpu_bytes": None,
        "max_disk_bytes": 20000000000,
        "max_edits_per_s": None,
        "max_viewers": 8,
    },
}
STREAM: dict[str, Any] = {
    "session": "s0123456789ab",
    "client": "fev-viewer",
    "address": "10.0.0.7:51234",
    "token": "Ada, desk 3",
    "scope": "controller",
    "run": RUN,
    "since": 1700000000.0,
}
STATUS: dict[str, Any] = {
    "connections": 3,
    "runs": 12,
    "workers": 2,
    "devices": ["cpu", "cuda:0"],
    "longest_publish_wait_s": 0.00002,
}
VERSION = {"server": "fev-solver", "version": "0.1.0", "protocol": "fev.v1"}
UPLOAD: dict[str, Any] = {
    "upload": "u0123456789ab",
    "label": "Ada, desk 3",
    "bytes_sent": 1048576,
    "status": "importing",
    "bytes_received": 1048576,
    "stage": "reading",
    "done": 0.0,
    "case": "",
    "message": "",
    "warnings": [],
    "since": 1700000000.0,
    "ended": None,
}
METRICS = """# HELP fev_connections Open streams.
# TYPE fev_connections gauge
fev_connections 3.0
"""
EVENTS = 'event: whole\ndata: {"service": {"service": {"runs": 12}}}\n\n'
PROBLEMS: dict[int, dict[str, str]] = {
    400: {"code": "invalid_request", "detail": "the body is no JSON"},
    401: {
        "code": "wrong_token",
        "detail": "the Authorization header must carry 'Bearer' and a token that holds",
    },
    403: {
        "code": "forbidden",
        "detail": "this needs the scope controller; the token has the scope viewer",
    },
    404: {"code": "not_found", "detail": "there is no run 'r000000000000'"},
    409: {"code": "refused", "detail": "there is no case 'atlantis'; there are jacksboro, malpasset"},
    413: {"code": "too_large", "detail": "the archive has more than the 1073741824 bytes allowed"},
    422: {"code": "invalid_request", "detail": "duration in the body: Input should be greater than 0"},
    429: {
        "code": "over_quota",
        "detail": "21 runs kept are too many for token 1f0a2b3c; 20 are allowed (max_runs)",
    },
    503: {"code": "unavailable", "detail": "16 operators watch already"},
    507: {"code": "store_failed", "detail": "frames of another run wait for room on the disk"},
}
