"""Pages that come back after the server has begun anew."""

from playwright.sync_api import expect


def test_what_was_before_stays_away_once_somebody_else_controls(view, tmp_path, open_page):
    secret = tmp_path / "token"
    secret.write_text("r" * 40)
    secret.chmod(0o600)
    server = view.serve(token_file=secret)
    pages = [open_page(server.url), open_page(server.url)]
    newest = [page.exact() for page in pages]
    pages[0].drag(-60, 20)
    pages[0].exact(newest[0])
    pages[1].until_shows(pages[0].pixels())
    port = server.port
    server.close()
    for page in pages:
        expect(page.page.get_by_text("Connection lost")).to_be_visible()
    with view.serve(port=port, token_file=secret):
        for page in pages:
            expect(page.page.get_by_text("Connection lost")).to_be_hidden()
        pages[0].page.wait_for_timeout(1000)
        controls = pages[0].page.get_by_text("You control").count() == 1
        mover, other = pages if controls else pages[::-1]
        newest = mover.exact()
        mover.drag(80, 30)
        mover.exact(newest)
        moved = mover.pixels()
        other.until_shows(moved)
        other.page.wait_for_timeout(5500)  # Then who controls is idle.
        other.page.get_by_role("button", name="Ask for control").click()
        expect(other.page.get_by_text("You control")).to_be_visible()
        other.page.wait_for_timeout(1500)
        other.exact()
        other.until_shows(moved)
