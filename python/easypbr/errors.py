"""The exceptions that EasyPBR raises; each also derives from a fitting built-in exception."""

__all__ = ["Error", "FileError", "FormatError", "ArgumentError", "UnknownNameError", "ShaderError", "ContextError"]


class Error(Exception):
    """Base of every exception of the library."""


class FileError(Error, OSError):
    """A file or folder cannot be opened, read or written."""


class FormatError(Error, ValueError):
    """A file is damaged, or of an unsupported kind."""


class ArgumentError(Error, ValueError):
    """A value is out of range, of the wrong shape or unknown."""


class UnknownNameError(Error, KeyError):
    """A named thing (mesh, light, setting) does not exist."""

    def __str__(self) -> str:
        """The message; KeyError would show it in quotes."""
        return Exception.__str__(self)


class ShaderError(Error, ValueError):
    """A custom shader does not compile; the message names the line."""


class ContextError(Error, RuntimeError):
    """No OpenGL context could be created, or a limit of the driver was exceeded."""
