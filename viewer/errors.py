"""The errors of the viewer.

ViewerError
+-- ContextError        no OpenGL context good enough could be made
+-- ShaderError         a shader file is missing or does not compile
+-- TerrainDataError    an array does not fit the terrain it is meant for
+-- ConnectionLost      the service went away and the connection cannot be kept
"""

__all__ = ["ConnectionLost", "ContextError", "ShaderError", "TerrainDataError", "ViewerError"]


class ViewerError(Exception):
    """Base of every error that the viewer raises on purpose; its text is one sentence for the user."""


class ContextError(ViewerError):
    """No OpenGL 4.1 core context could be made; the text names what was found or which package is missing."""


class ShaderError(ViewerError):
    """A shader could not be read or compiled; the text names file and line."""


class TerrainDataError(ViewerError):
    """An array has the wrong shape, type or values for the terrain it is meant for."""


class ConnectionLost(ViewerError):
    """The connection to the service ended; the text says why and whether it is tried again."""
