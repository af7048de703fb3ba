"""Where the terrain of the Malpasset case comes from: a data folder, the cache, or the public mesh.

The mesh of the TELEMAC-2D example is not part of this distribution (its licence differs). It is downloaded
once, checked, and laid on the 15 m cells that the case file names.
"""

from __future__ import annotations

import logging
import os
import tempfile
from pathlib import Path

import numpy as np

from solver_service.errors import CaseError

NAME = "malpasset"
FILE = "malpasset_15m.npz"
URL = (
    "https://raw.githubusercontent.com/ogoe/OpenTelemac/0e7a83278e8d9c8b9bf7390a2e9e113432ec0c5f/"
    "examples/telemac2d/malpasset/geo_malpasset-large.slf"
)
SHA256 = "9f2bf1771050a2818678f691edbaaed5917ec7d6ad7ed36c160e1083c8e9bb39"
LICENCE = "GNU GPL 3, as a mirror of the TELEMAC-2D example states"
DX = 15.0
BOUNDS = (530.0, -2350.0, 17780.0, 6845.0)
"""Edges of the cells [m]: 1150 columns, 613 rows."""
OUTSIDE = 101.0
"""Elevation written outside the mesh [m]."""

LOG = logging.getLogger(__name__)


def cache_folder() -> Path:
    """Where downloaded cases are kept."""
    from platformdirs import user_cache_path

    return user_cache_path("fev", appauthor=False) / "cases" / NAME


def local_folder() -> Path | None:
    """A folder that holds the terrain on this machine; None where there is none."""
    home = os.environ.get("FEV_DATA_HOME")
    folders = [Path(home) / NAME] if home else []
    return next((folder for folder in (*folders, cache_folder()) if (folder / FILE).is_file()), None)


def data_folder() -> Path:
    """The folder that holds the terrain; downloads it where it is not on this machine.

    Raises:
        CaseError: it is nowhere, and the download fails.
    """
    folder = local_folder()
    return folder if folder is not None else download(cache_folder())


def download(folder: Path, url: str = URL, sha256: str = SHA256) -> Path:
    """Fetch the mesh and lay it on the cells of the case.

    Args:
        folder: where the terrain is kept.
        url: address of the mesh.
        sha256: checksum that the file must have.

    Raises:
        CaseError: the download fails or is not the file expected.
    """
    import pooch

    LOG.warning("Downloading the Malpasset mesh from %s (licence: %s).", url, LICENCE)
    pooch.get_logger().setLevel(logging.ERROR)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder) as scratch:
            mesh = pooch.retrieve(
                url,
                known_hash=f"sha256:{sha256}",
                fname="mesh.slf",
                path=scratch,
                downloader=pooch.HTTPDownloader(timeout=30),
            )
            convert(Path(mesh), Path(scratch) / FILE)
            os.replace(Path(scratch) / FILE, folder / FILE)
    except (OSError, ValueError) as error:
        raise CaseError(
            f"The terrain of the case '{NAME}' is neither in FEV_DATA_HOME nor in {folder}, and its"
            " download from"
            f" {url} failed: {str(error).splitlines()[0]}."
        ) from error
    return folder


def convert(mesh: Path, output: Path) -> None:
    """Write the bed of the mesh on the cells of the case, row 0 in the north.

    Args:
        mesh: the .slf or .slf.gz file.
        output: the .npz to write.

    Raises:
        TerrainError: the file is not such a mesh.
    """
    from solver_service.terrain.read_selafin import read_selafin

    raster = read_selafin(mesh, DX, BOUNDS)
    bed = np.where(raster.void, OUTSIDE, raster.values).astype(np.float32)[::-1]
    np.savez_compressed(output, bed=bed, inside=~raster.void[::-1], dx=DX, x0=BOUNDS[0], y0=BOUNDS[1])
