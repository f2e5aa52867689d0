"""A served view in a frame of another site's page."""

import functools
import http.server
import threading

import pytest


@pytest.fixture
def site(tmp_path):
    """Another site: a folder, and its address."""
    class Quiet(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=tmp_path))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield tmp_path, f"http://127.0.0.1:{server.server_address[1]}"
    server.shutdown()


def framed(browser, site, url):
    folder, address = site
    (folder / "index.html").write_text(f'<iframe id="view" src="{url}" width="640" height="400"></iframe>')
    page = browser.new_context().new_page()
    page.goto(address)
    return page


@pytest.mark.parametrize("is_known", [True, False])
def test_a_site_that_is_named_shows_the_view(view, browser, site, is_known):
    with view.serve(origins=[site[1]] if is_known else []) as server:
        page = framed(browser, site, server.watch_url)
        canvas = page.frame_locator("#view").locator("canvas.picture[data-exact='true']")
        if is_known:
            canvas.wait_for(timeout=60000)
            assert server.clients[0].watches_only
        else:
            page.wait_for_timeout(3000)
            assert canvas.count() == 0 and not server.clients
        page.context.close()
