"""How a server ends while a forked child holds copies of its sockets, as workers of a DataLoader do."""

import contextlib
import os
import signal
import socket
import warnings

import pytest

from client import Client


@contextlib.contextmanager
def forked_child():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of Python 3.12: there are threads, which this child needs none of
        child = os.fork()
    if child == 0:
        while True:
            signal.pause()
    try:
        yield
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def connected(family, address):
    connection = socket.socket(family)
    connection.settimeout(1)
    connection.connect(address)
    return connection


def is_served(connection):
    connection.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    return connection.recv(12) == b"HTTP/1.1 200"


def ends(view, options, family, address):
    """Everybody sees the end within a second, nobody can connect any more, and the place can be taken again."""
    server = view.serve(**options)
    place = address(server)
    with connected(family, place) as silent, connected(family, place) as last:
        client = None if server.port == 0 else Client(server.url)
        if client:
            client.until_told("welcome")
        # It has been accepted after the others.
        assert is_served(last)
        with forked_child():
            server.close()
            assert silent.recv(1) == b""
            if client:
                assert client.until_closed() == (1001, "the server ends")
                client.close()
            with pytest.raises(ConnectionRefusedError):
                connected(family, place)
            with view.serve(**{**options, "port": server.port}) as again:
                with connected(family, address(again)) as connection:
                    assert is_served(connection)


def test_a_port(view):
    ends(view, {}, socket.AF_INET, lambda server: ("127.0.0.1", server.port))


def test_a_unix_socket(view, tmp_path):
    """Its own name is gone once it is closed: another one leads to it still, or to the next."""
    path, other = tmp_path / "socket", tmp_path / "other"

    def address(_):
        other.unlink(missing_ok=True)
        os.link(path, other)
        return str(other)

    ends(view, {"socket": path}, socket.AF_UNIX, address)
