"""Refuses sub-interpreters when it is imported, before the module _easypbr is: there its calls would wait for ever, for the lock of
an interpreter that they take for the main one, and making it once more would spoil that of the main interpreter."""


def _is_main() -> bool:
    try:
        import ctypes
    except ImportError:
        # An isolated interpreter, to which Python gives neither ctypes nor _easypbr, or a Python without ctypes.
        return True
    # Both are of the stable ABI; the main interpreter is the first one, 0.
    current = ctypes.PYFUNCTYPE(ctypes.c_void_p)(("PyInterpreterState_Get", ctypes.pythonapi))
    number = ctypes.PYFUNCTYPE(ctypes.c_int64, ctypes.c_void_p)(("PyInterpreterState_GetID", ctypes.pythonapi))
    return number(current()) == 0


if not _is_main():
    raise ImportError("easypbr works in the main interpreter only: use threads or processes in place of sub-interpreters")
