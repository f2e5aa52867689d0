"""Wheel, keys and places in the picture, where browsers and displays differ."""

from playwright.sync_api import expect

from conftest import Page

# 240 frames a second, each with an event of the wheel.
QUICK_DISPLAY = """(() => {
    let calls = [], id = 0, due = performance.now();
    window.requestAnimationFrame = (call) => { calls.push([++id, call]); return id; };
    window.cancelAnimationFrame = (which) => { calls = calls.filter(([known]) => known !== which); };
    window.wheel = () => {};
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
        const now = performance.now();
        if (now >= due) {
            due = Math.max(due + 1000 / 240, now - 50);
            window.wheel();
            const present = calls;
            calls = [];
            for (const [, call] of present) call(now);
        }
        channel.port2.postMessage(0);
    };
    channel.port2.postMessage(0);
})()"""


def test_the_wheel_of_a_quick_display_keeps_the_connection(browser, server):
    context = browser.new_context(viewport={"width": 300, "height": 240})
    context.add_init_script(QUICK_DISPLAY)
    kinds = []
    context.on("page", lambda page: page.on("websocket", lambda socket: socket.on("framesent", lambda text: kinds.append(str(text)))))
    page = Page(context, server.url, [])
    page.exact()
    kinds.clear()
    page.canvas.evaluate("""canvas => {
        window.wheel = () => canvas.dispatchEvent(new WheelEvent("wheel", {
            deltaY: 1, clientX: 80, clientY: 80, cancelable: true, bubbles: true }));
    }""")
    page.page.wait_for_timeout(3000)
    assert not any('"hello"' in text for text in kinds)
    sent = [text for text in kinds if '"pointer"' in text]
    assert 30 < len(sent) < 3 * 90
    assert all('"wheel"' in text.split('"button"')[0] for text in sent)
    context.close()


def test_a_key_that_comes_up_with_alt_stops_the_flight(open_page):
    page = open_page()
    page.exact()
    page.canvas.focus()
    keyboard = page.page.keyboard
    keyboard.down("w")
    page.page.wait_for_timeout(200)
    keyboard.down("Alt")
    keyboard.up("w")
    keyboard.up("Alt")
    page.page.wait_for_timeout(500)
    stopped = page.exact()
    page.page.wait_for_timeout(1000)
    assert page.exact() == stopped


def test_places_in_a_large_picture_are_those_of_the_pointer(open_page):
    """Of more pixels than a picture may have on a side."""
    page = open_page(width=5120, height=700)
    page.page.get_by_role("button", name="Controls").click()
    # The picture from before the click is as wide, but not as high.
    page.page.wait_for_function("""() => {
        const c = document.querySelector('canvas.picture');
        const fits = Math.abs(c.width / c.clientWidth - c.height / c.clientHeight) < 0.002;
        return c.width === 4096 && fits && c.dataset.exact === 'true';
    }""")
    high = page.canvas.evaluate("c => c.clientHeight")
    x, y = page.centre()
    read_out = page.page.get_by_label("Picked")
    page.page.mouse.click(x, y)
    expect(read_out.locator("strong")).to_have_text("ball")
    # The ball is as high as it is wide: what lies beside it is the bar, then nothing.
    page.page.wait_for_timeout(600)
    page.page.mouse.click(x + high, y)
    expect(read_out).to_have_count(0)
