"""The report page of a real, small bench in a real browser: what it shows, and what foreign texts cannot do to it."""
import argparse
import contextlib
import http.server
import json
import pathlib
import shutil
import subprocess
import sys
import threading

from chromium import Browser
from png import decode

SKIPPED = 77

SUITE = """
name = "report"
sizes = ["64x48"]
time_size = "96x72"
frames = 2
warmup = 0
term = "visibility"
reference = {spp = 16}
pictures = true
[[scenes]]
scene = "balls"
lights = ["key"]
max_masked_share = 0.05
[[techniques]]
technique = "hard_shadow_map"
label = "Hard shadows"
[[techniques]]
technique = "pcss"
parameters = {blocker_samples = 4, filter_samples = [4, 64]}
baseline = true
[[techniques]]
technique = "sampled_area_light"
parameters = {samples = [1, 4], shadow_map_size = 128}
"""
POINTS = 5
ROWS, BEFORE_PICTURES = 400, 2 << 20  # bytes of the page that are read before it is first drawn
HEADING = "document.querySelector('.detail h3').textContent"
# The whole pictures of all rows and references, as data URIs: a row's picture and difference, the table's reference first.
WHOLE = """() => JSON.parse(document.getElementById('data').textContent).tables
    .flatMap(({rows: [first, ...others], reference}) => [first.picture, first.difference, reference.picture,
        ...others.flatMap(row => [row.picture, row.difference])])
    .filter(p => p.whole >= 0).map(p => document.getElementById(`picture-${p.whole}`).textContent)"""
HOSTILE = "</script><img src=x onerror=\"window.harmed = true\"><script>window.harmed = true</script>{{data}}{{pictures}}"

# What a name may hold; ADDRESS is a server that counts who asks.
HOSTILE_TEXTS = [
    "</script><script>window.harmed = true</script>",
    "<img src=x onerror='window.harmed = true'><svg onload='window.harmed = true'>",
    "<img src='ADDRESS/image'><link rel=stylesheet href='ADDRESS/style'><iframe src='ADDRESS/frame'></iframe>",
    "javascript:window.harmed = true",
    "url(ADDRESS/url) } * { background: url(ADDRESS/background) }",
    "\" onmouseover=\"window.harmed = true\" x='",
    "{{data}} {{style}} ${window.harmed = true} {{constructor.constructor('window.harmed = true')()}}",
    "<!--<script> --> ]]> &lt;b&gt; \u2028window.harmed = true\u2029",
    "\u202egnp.txet\u202c \u2066isolated\u2069 \u200fmark",
    "__proto__ constructor toString",
    "../../../../etc/passwd",
    "W" * 5000,
    "long name with spaces " * 300,
    "\x1b[31mred\x07\x00 \ud83d\ude00",
]

parser = argparse.ArgumentParser()
for option in ("limn", "chromium", "scratch"):
    parser.add_argument("--" + option, required=True)
options = parser.parse_args()
if not pathlib.Path(options.chromium).is_file():
    print("skipped: no chromium (Debian package chromium)")
    sys.exit(SKIPPED)

out = pathlib.Path(options.scratch).resolve() / "out"
page = out / "index.html"
results = out / "results.jsonl"


def limn(*arguments):
    subprocess.run([options.limn, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def bench():
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    (out / "suite.toml").write_text(SUITE)
    limn("bench", out / "suite.toml", "--out", out)


def shows_points_and_pictures(browser):
    browser.open(page)
    check(browser.evaluate("document.querySelectorAll('g.point').length") == POINTS, "not every row is a point")
    check(browser.evaluate("document.querySelectorAll('g.point.pareto').length") >= 1, "no Pareto front")
    check(browser.evaluate("document.querySelectorAll('.level.noise').length") == 1, "no noise of the reference")
    check(browser.evaluate("[...document.images].every(i => i.complete && i.naturalWidth > 0)"), "a picture is missing")
    check(browser.evaluate("document.querySelectorAll('.detail img').length") == 3, "not picture, difference, reference")
    check(browser.evaluate("document.querySelectorAll('.equal-ms img.magnified').length") >= 4, "no pictures at equal time")
    check(browser.evaluate("document.querySelectorAll('.spectrum .curve.current').length") == 1, "no spectrum")
    check(browser.evaluate("document.querySelectorAll('table').length") == 4, "not four tables")
    check("times as fast" in browser.evaluate("document.querySelector('table').textContent"), "no ratios to the baseline")
    check("96 x 72, 1 light" in browser.evaluate("document.body.textContent"), "no frames per second by resolution and lights")


def hover(browser):
    """The points' centres in whole pixels, and what the pointer shows at each."""
    centres = browser.evaluate("""[...document.querySelectorAll('g.point')].map(p => {
        p.scrollIntoView({block: 'center'}); const centre = p.getScreenCTM();
        return {x: centre.e, y: centre.f + scrollY}; })""")
    seen = set()
    for centre in centres:
        browser.evaluate(f"scrollTo(0, {centre['y'] - 300})")
        browser.point(centre["x"], centre["y"] - browser.evaluate("scrollY"))
        seen.add(browser.evaluate(HEADING))
    return {(round(centre["x"]), round(centre["y"])) for centre in centres}, seen


def reacts(browser):
    """Hovering, arrow keys, drop-downs, sliders and the tables' buttons."""
    places, seen = hover(browser)
    check(len(seen) >= len(places), f"hovering shows only {seen}")

    browser.evaluate("document.querySelector('g.point[tabindex=\"0\"]').focus()")
    browser.press("Home")
    walked = [browser.evaluate(HEADING)]
    for _ in range(POINTS - 1):
        browser.press("ArrowRight")
        walked.append(browser.evaluate(HEADING))
    check(len(set(walked)) == POINTS, f"the arrow keys reach only {walked}")
    check(browser.evaluate("document.querySelectorAll('g.point[aria-pressed=true]').length") == 1, "not one current point")

    choose = """(label, value) => { const select = [...document.querySelectorAll('.chooser')]
        .find(c => c.firstChild.textContent === label).querySelector('select');
        select.value = value; select.dispatchEvent(new Event('change')); }"""
    plot = "document.querySelector('svg.plot')"
    before = browser.evaluate(f"{plot}.outerHTML")
    browser.evaluate(f"({choose})('Error', 'flip')")
    check("FLIP" in browser.evaluate(f"{plot}.getAttribute('aria-label')"), "the error cannot be chosen")
    check(browser.evaluate(f"{plot}.outerHTML") != before, "another error, the same chart")
    browser.evaluate("""[...document.querySelectorAll('.chooser')].find(c => c.firstChild.textContent === 'Time')
        .querySelector('select').focus()""")
    browser.evaluate(f"({choose})('Time', 'shadows')")
    check(browser.evaluate("document.activeElement.closest('.chooser')?.firstChild.textContent") == "Time", "a choice loses the focus")
    check("technique" in browser.evaluate(f"{plot}.querySelector('.axis').textContent"), "the time cannot be chosen")

    text = "document.querySelector('.equal-ms .note').textContent"
    before = browser.evaluate(text)
    browser.evaluate("""(s => { s.value = s.value > 50 ? 0 : 100; s.dispatchEvent(new Event('input')); })(
        document.querySelector('.equal-ms input'))""")
    check(browser.evaluate(text) != before, "the slider does nothing")
    browser.evaluate("[...document.querySelectorAll('th button')].at(-1).click()")
    check("sampled_area_light" in browser.evaluate(HEADING), "the table's button shows nothing")


def is_resized(browser):
    """Charts are drawn once, and again for another width; what has the focus beside them keeps it. Shortcuts stay the browser's."""
    counting = browser.call("Page.addScriptToEvaluateOnNewDocument", source="""window.drawn = 0; new MutationObserver(changes => {
        for (const {addedNodes} of changes) window.drawn += [...addedNodes].filter(n => n.matches?.('svg.plot')).length;
        }).observe(document, {childList: true, subtree: true})""")
    browser.open(page)
    browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=counting["identifier"])
    check(browser.evaluate("window.drawn") == 1, "a chart is drawn more than once before anybody asks for it")
    width = "document.querySelector('svg.plot').getAttribute('width')"
    before = browser.evaluate(width)
    browser.evaluate("document.querySelector('.detail button.framed').focus()")
    browser.call("Emulation.setDeviceMetricsOverride", width=800, height=900, deviceScaleFactor=1, mobile=False)
    browser.settle()
    check(browser.evaluate(width) != before, "the chart keeps the width of another window")
    check(browser.evaluate("document.activeElement.matches('.detail button.framed')"), "another width takes the focus away")
    for what in ("document.querySelector('g.point[tabindex=\"0\"]').focus()", "document.querySelector('.detail button.framed').click()"):
        browser.evaluate(what)
        browser.settle()
        for key in ("ArrowLeft", "ArrowRight"):
            check(browser.evaluate(f"""document.activeElement.dispatchEvent(new KeyboardEvent('keydown',
                {{key: '{key}', altKey: true, bubbles: true, cancelable: true}}))"""), f"{key} with Alt is taken from the browser")


def slide(browser, where, position):
    browser.evaluate(f"""(s => {{ s.value = {position}; s.dispatchEvent(new Event('input')); }})(
        document.querySelector('{where} input[type=range]'))""")


def answers_for_a_budget(browser):
    """The setting to take: of least error in a time, or quickest at an error; with its command, for one scene and over several."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    time = lambda row: row["stats"]["frame_ms"]["median"]
    error = lambda row: row["penumbra"]["rmse"]
    setting = lambda row: row.get("title") or row["technique"]
    browser.open(page)
    check(browser.evaluate("document.querySelector('#take')") is None, "an overview of one scene")
    for position, best in ((0, min(rows, key=time)), (100, min(rows, key=error))):
        slide(browser, ".take", position)
        text = browser.evaluate("document.querySelector('.take p strong').textContent")
        check(setting(best) in text, f"at {position} % {text} is taken instead of {setting(best)}")
    shown = browser.evaluate("document.querySelector('.take code').textContent")
    check(shown.startswith("limn render balls --technique ") and shown.endswith("--out picture.png"), f"the command is {shown}")
    check(browser.evaluate("document.querySelector('g.level.budget').style.display") != "none", "no line at the budget")
    browser.evaluate("document.querySelector('.take .command button').click()")
    browser.settle()
    check(browser.evaluate("document.querySelector('.take .command button').textContent") in ("Copied", "Selected"), "nothing is copied")
    limn(*shown.replace("picture.png", str(out / "command.png")).split()[1:])
    check((out / "command.png").is_file(), "the command does not render")

    noisy = [json.loads(json.dumps(row)) for row in rows]
    for i, row in enumerate(noisy):
        row["penumbra"].update(noise_floor=1, rmse=1e-5 * 10 ** i)
    with reported(noisy):
        browser.open(page)
        browser.evaluate("""(s => { s.value = 'error'; s.dispatchEvent(new Event('change')); })(
            [...document.querySelectorAll('.take .chooser')].find(c => c.firstChild.textContent === 'Budget').querySelector('select'))""")
        slide(browser, ".take", 0)
        text = browser.evaluate("document.querySelector('.take p').textContent")
        check(f"Take {setting(min(rows, key=time))} " in text and "<1" in text, f"of errors below the noise: {text}")
        equal = browser.evaluate("document.querySelector('.equal-error').textContent")
        check("RMSE in the penumbra: 1," in equal and "Not near it" not in equal, f"errors below the noise differ: {equal}")

    others = [json.loads(json.dumps(row)) for row in rows]
    for row in others:
        row.update(scene="elsewhere", key=row["key"] + "e")
    with reported([*rows, *others]):
        browser.open(page)
        slide(browser, "#take", 100)
        lines = browser.evaluate("[...document.querySelectorAll('#take table')[0].tBodies[0].rows].map(r => r.cells[1].textContent)")
        check(lines == [setting(min(rows, key=error))] * 2, f"over both scenes {lines}")
        check(browser.evaluate("document.querySelectorAll('[aria-live] table').length") == 0, "whole tables are read aloud")
        said = browser.evaluate("document.querySelector('#take p[aria-live]').textContent")
        check("2 of 2 scenes" in said and min(rows, key=error)["technique"] in said, f"aloud is said {said}")
        best = browser.evaluate("[...document.querySelectorAll('#take table')[1].tBodies[0].rows[0].cells].map(c => c.textContent)")
        check(best[:2] == [min(rows, key=error)["technique"], "2"] and best[3] == "2", f"of two scenes {best}")
        browser.evaluate("[...document.querySelectorAll('#take th button')].at(-1).click()")
        browser.settle()
        check(browser.evaluate("Math.abs(document.querySelector('#subject-1').getBoundingClientRect().top) < 60"), "it does not go there")
        browser.evaluate("""(s => { s.value = 'error'; s.dispatchEvent(new Event('change')); })(
            [...document.querySelectorAll('#take .chooser')].find(c => c.firstChild.textContent === 'Budget').querySelector('select'))""")
        slide(browser, "#take", 100)
        lines = browser.evaluate("[...document.querySelectorAll('#take table')[0].tBodies[0].rows].map(r => r.cells[1].textContent)")
        check(lines == [setting(min(rows, key=time))] * 2, f"of any error {lines}")

    lost = [json.loads(json.dumps(row)) for row in rows]
    for row in lost:
        row.update(scene="lost", key=row["key"] + "l", failure="crashed", renderer=row["stats"]["renderer"])
    with reported([*rows, *others, *lost]):
        browser.open(page)
        slide(browser, "#take", 100)
        said = browser.evaluate("document.querySelector('#take p[aria-live]').textContent")
        check("2 of 3 scenes" in said, f"of a scene in which every row failed is said {said}")
        lines = browser.evaluate("[...document.querySelectorAll('#take table')[0].tBodies[0].rows].map(r => r.cells[1].textContent)")
        check("no row has both a time and this error" in lines, f"over three scenes {lines}")


def enlarges_and_flips(browser):
    """A picture over the window, which the keys flip in place."""
    browser.open(page)
    source = "document.querySelector('dialog img').src"
    pictures = browser.evaluate(f"({WHOLE})().slice(0, 3)")
    browser.evaluate("document.querySelector('.detail button.framed').focus()")
    browser.evaluate("document.activeElement.click()")
    check(browser.evaluate("document.querySelector('dialog').open && document.querySelector('dialog').contains(document.activeElement)"),
          "no dialog has the focus")
    seen = [browser.evaluate(source)]
    for key in ("ArrowRight", "ArrowRight", " ", " ", "ArrowRight", "ArrowLeft"):
        browser.press(key)
        seen.append(browser.evaluate(source))
    expected = [pictures[i] for i in (0, 1, 2, 1, 2, 0, 2)]
    check(seen == expected, f"the keys flip to {[pictures.index(s) for s in seen]}")
    browser.evaluate("document.querySelector('dialog [data-close]').focus()")
    browser.press(" ")
    check(browser.evaluate("document.querySelector('dialog') === null && document.activeElement.matches('.detail button.framed')"),
          "closing does not go back")


def loads_pictures_on_demand(browser):
    """Many rows: the page is drawn before any picture is read, and whole pictures are decoded where somebody asks for them."""
    first = [json.loads(line) for line in results.read_text().splitlines()]
    rows = []
    for i in range(ROWS):
        row = json.loads(json.dumps(first[i % POINTS]))
        row.update(key=f"many{i}", scene=f"scene_{i // 20}",
                   parameters={**row["parameters"], f"{row['technique']}.copy": str(i)})
        for key in ("picture", "difference"):
            copy = f"pictures/{key}_{i}.png"
            shutil.copy(out / row[key], out / copy)
            row[key] = copy
        rows.append(row)
    count = "document.querySelectorAll('script[id^=picture-]').length"
    drawn = browser.call("Page.addScriptToEvaluateOnNewDocument", source=f"""new MutationObserver((_, observer) => {{
        if (!document.querySelector('section')) return;
        window.picturesWhenDrawn = {count};
        observer.disconnect(); }}).observe(document, {{childList: true, subtree: true}})""")
    with reported(rows):
        text = page.read_text()
        before, data = text.index('<script type="text/plain" id="picture-'), text.index('id="data"')
        check(before <= BEFORE_PICTURES, f"{before} bytes are read before the first paint, of {len(text)}")
        check("data:image/" not in text[data:before], "a picture stands before the first paint")
        browser.open(page)
        browser.call("Page.removeScriptToEvaluateOnNewDocument", identifier=drawn["identifier"])
        check(browser.evaluate("window.picturesWhenDrawn") == 0, "the page is drawn after its pictures are read")
        check(browser.evaluate(count) >= 4 * ROWS, "pictures are missing")
        check(browser.evaluate("[...document.images].every(i => i.complete && i.naturalWidth > 0)"), "a picture is not shown")
        shown = f"(whole => [...document.images].filter(i => whole.has(i.src)).map(i => i.className))(new Set(({WHOLE})()))"
        check(browser.evaluate(shown) == [], "whole pictures are decoded before anybody asks for them")
        browser.evaluate("document.querySelector('.framed').click()")
        browser.settle()
        check(browser.evaluate(shown) == ["enlarged"], "the enlarged picture is not the whole one")
        check(browser.evaluate("document.querySelector('dialog img').naturalWidth") == 64, "the whole picture is reduced")
    for row in rows:
        for key in ("picture", "difference"):
            (out / row[key]).unlink()


def is_painted(browser):
    """Every marker has its curve's colour on the screen, and stands off the ground by 3:1, in both schemes."""
    contrast = """(a, b) => { const level = c => { const [r, g, b] = c.map(v => v / 255)
        .map(v => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
        const [dark, light] = [level(a), level(b)].sort((x, y) => x - y); return (light + 0.05) / (dark + 0.05); }"""
    grounds = []
    for scheme in ("light", "dark"):
        browser.open(page, height=1600, scheme=scheme)
        rgb = "c => c.match(/\\d+/g).slice(0, 3).map(Number)"
        marks = browser.evaluate(f"""[...document.querySelectorAll('g.point')].map(p => {{
            const m = p.querySelector('.marker'), box = m.getBoundingClientRect();
            return {{x: Math.round(box.x + box.width / 2), y: Math.round(box.y + box.height / 2),
                     colour: ({rgb})(getComputedStyle(m).fill)}}; }})""")
        ground = browser.evaluate(f"({rgb})(getComputedStyle(document.body).backgroundColor)")
        grounds.append(ground)
        pixels = decode(browser.screenshot())
        for mark in marks:
            painted = [pixel for row in pixels[mark["y"] - 3:mark["y"] + 4] for pixel in row[mark["x"] - 3:mark["x"] + 4]]
            others = [other["colour"] for other in marks]  # a later marker may cover this one
            check(any(max(abs(a - b) for a, b in zip(pixel, other)) < 12 for pixel in painted for other in others),
                  f"{scheme}: the marker at {mark} is not painted")
        check(len({tuple(mark["colour"]) for mark in marks}) == 3, f"{scheme}: curves share a colour")
        for i in range(6):
            colour = browser.evaluate(f"""(() => {{ const probe = document.body.appendChild(document.createElement('i'));
                probe.style.color = 'var(--curve-{i})'; return ({rgb})(getComputedStyle(probe).color); }})()""")
            ratio = browser.evaluate(f"({contrast})({colour}, {ground})")
            check(ratio >= 3, f"{scheme}: curve {i} has a contrast of {ratio:.2f}")
    check(grounds[0] != grounds[1], "dark and light look the same")


def is_accessible(browser):
    browser.open(page, width=360, height=740)
    check(browser.evaluate("document.documentElement.scrollWidth") <= 360, "wider than a phone")
    check(browser.evaluate("document.querySelectorAll('g.point').length") == POINTS, "points are missing on a phone")
    for what, expression in {
            "picture without a text": "[...document.images].filter(i => !i.alt).length",
            "chart without a name": "[...document.querySelectorAll('svg.plot, svg.spectrum, .sparkline')]"
                                    ".filter(s => !s.getAttribute('aria-label')).length",
            "point without a name": "document.querySelectorAll('g.point:not([aria-label])').length",
            "field without a label": "[...document.querySelectorAll('select, input')].filter(f => !f.labels.length).length",
            "table without a caption": "[...document.querySelectorAll('table')].filter(t => !t.caption).length",
            "button without a name": "[...document.querySelectorAll('button')].filter(b => !b.textContent.trim() &&"
                                     " !b.querySelector('img[alt]:not([alt=\"\"])')).length",
            "picture to enlarge that is no button": "document.querySelectorAll('.framed:not(button[type=button])').length",
            "element identifier used twice": "(i => i.length - new Set(i).size)([...document.querySelectorAll('[id]')].map(e => e.id))",
    }.items():
        check(browser.evaluate(expression) == 0, what)


@contextlib.contextmanager
def reported(rows):
    """The report of other rows, until the end of the block."""
    kept = results.read_text()
    results.write_text("".join(json.dumps(row) + "\n" for row in rows))
    limn("report", out)
    yield
    results.write_text(kept)
    limn("report", out)


def tells_close_points_apart(browser):
    """Points that cover each other: the pointer means the nearest."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    times = rows[0]["stats"]["frame_ms"], rows[0]["stats"]["frame_samples_ms"]
    for i, row in enumerate(rows):
        row.update(error=rows[0]["error"], penumbra=rows[0]["penumbra"])
        row["stats"]["frame_ms"] = {key: value if key == "n" else value * 1.03 ** i for key, value in times[0].items()}
        row["stats"]["frame_samples_ms"] = [value * 1.03 ** i for value in times[1]]
    with reported(rows):
        browser.open(page)
        places, seen = hover(browser)
        check(len(places) == POINTS and len(seen) == POINTS, f"of {places} hovering shows only {seen}")


def sets_the_reference_beside(browser):
    """Where errors and times are of one picture, the reference's own method has a line and a column."""
    check("reference ms" not in browser.evaluate("document.querySelector('table').textContent"), "a time for errors of another size")
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    for row in rows:
        row.update(time_size=[0, 0], term="direct")
        row["stats"]["software"] = True  # only such frames have the reference's processor
        row.pop("penumbra")
        row["reference"]["seconds"] = 2e-3 * row["stats"]["frame_ms"]["median"]
        row["error"]["noise_floor"] = 3 * row["error"]["rmse"]
    with reported(rows):
        browser.open(page)
        check(browser.evaluate("document.querySelectorAll('.level.traced line').length") == 1, "no line of the reference")
        check("reference ms" in browser.evaluate("document.querySelector('table').textContent"), "no time of the reference")
    # The first point lies over the beginning of the line, where the label would stand.
    for row, (ms, error) in zip(rows, ((1, 0.01), (100, 0.1), (100, 0.05), (50, 0.1), (50, 0.05))):
        row["stats"]["frame_ms"].update(median=ms, q1=ms, q3=ms)
        row["stats"]["frame_samples_ms"] = [ms] * row["stats"]["frame_ms"]["n"]
        row["error"].update(rmse=error, noise_floor=0.003)
        row["reference"]["seconds"] = 0.07
    with reported(rows):
        browser.open(page)
        covered = browser.evaluate("""(label => [...document.querySelectorAll('g.point .marker, g.point .ring')]
            .map(mark => mark.getBoundingClientRect()).filter(mark => mark.left < label.right && mark.right > label.left &&
                mark.top < label.bottom && mark.bottom > label.top).length)(
            document.querySelector('.level.traced text').getBoundingClientRect())""")
        check(covered == 0, "a marker covers the label of the reference's line")


def keeps_machines_and_programs_apart(browser):
    """Frames per second of one machine alone, and marks where another version of the program measured."""
    speeds = """[...document.querySelectorAll('#subject-0 table')].find(t => t.caption.textContent.startsWith('Frames per second'))
        .tHead.textContent"""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    others = [json.loads(json.dumps(row)) for row in rows]
    for row in others:
        row.update(key=row["key"] + "o", time_size=[192, 144])
    with reported([*rows, *others]):
        browser.open(page)
        check("192 x 144" in browser.evaluate(speeds), "one machine's resolutions have no columns")
        check("†" not in browser.evaluate("document.getElementById('results').textContent"), "rows of one program are marked")
    for row in rows:
        row["stats"]["machine"] = "a"
    for row in others:
        row["stats"]["machine"] = "b"
    rows[0]["provenance"]["program"] = "another"
    rows[0]["stats"]["frame_ms"].update(median=0.01, q1=0.01, q3=0.01)  # the quickest
    with reported([*rows, *others]):
        browser.open(page)
        shown = browser.evaluate(speeds)
        check("96 x 72" in shown and "192 x 144" not in shown, f"two machines share a table: {shown}")
        marked = browser.evaluate("[...document.querySelectorAll('#subject-0 table tbody tr[data-key] th')].map(h => h.textContent)")
        check(len(marked) == POINTS and [name for name in marked if "†" in name] == ["Hard shadows †"], f"marked are {marked}")
        check("† measured with another version" in browser.evaluate("document.getElementById('results').textContent"), "the mark is not explained")
        check("†" in browser.evaluate(HEADING), "the setting that is looked at has no mark")
        speed_rows = browser.evaluate("""[...[...document.querySelectorAll('#subject-0 table')]
            .find(t => t.caption.textContent.startsWith('Frames per second')).tBodies[0].rows].map(r => r.textContent)""")
        check([line.startswith("Hard shadows") for line in speed_rows if "†" in line] == [True], f"speeds are marked in {speed_rows}")
        equal = browser.evaluate("[...document.querySelectorAll('.equal')].map(e => e.textContent)")
        check(all(("†" in text) == ("† measured with another version" in text) for text in equal), f"pictures have marks alone: {equal}")
        slide(browser, ".equal-ms", 0)
        names = browser.evaluate("[...document.querySelectorAll('.equal-ms figcaption strong')].map(s => s.textContent)")
        check("Hard shadows †" in names, f"the quickest setting has no mark at equal time: {names}")
        slide(browser, ".take", 0)
        taken = browser.evaluate("document.querySelector('.take').textContent")
        check("Take Hard shadows †" in taken and "† measured with another version" in taken, f"what to take has no mark: {taken}")
    for part in ("error", "penumbra"):
        rows[0][part]["rmse"] = 1e-9  # the best, too
    with reported([*rows, *others]):
        browser.open(page)
        slide(browser, ".take", 100)
        taken = browser.evaluate("document.querySelector('.take p').textContent")
        check(taken.startswith("Take ") and "†" not in taken, f"an outdated row comes before the newest ones: {taken}")


def tells_references_apart(browser):
    """One scene with two references: one section of two tables with names of their own, and no answer over several scenes."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    others = [json.loads(json.dumps(row)) for row in rows]
    for row in others:
        row.update(key=row["key"] + "r", quality={**row["quality"], "spp": 64})
        row["reference"]["noise_rms"] = 2.1
        row["stats"]["frame_ms"] = {key: value if key == "n" else 10 * value for key, value in row["stats"]["frame_ms"].items()}
    with reported([*rows, *others]):
        browser.open(page)
        check(browser.evaluate("document.querySelectorAll('main > section').length") == 1, "a scene is two")
        check(browser.evaluate("document.querySelector('#take')") is None, "an overview of one scene")
        choice = """[...document.querySelectorAll('.chooser')].find(c => c.firstChild.textContent === 'Measured')
            .querySelector('select')"""
        names = browser.evaluate(f"[...{choice}.options].map(o => o.textContent)")
        check(len(names) == 2 and "against 16 spp" in names[0] and "against 64 spp" in names[1], f"the tables are called {names}")
        speeds = """[...document.querySelectorAll('#subject-0 table')]
            .find(t => t.caption.textContent.startsWith('Frames per second')).tBodies[0].textContent"""
        first = browser.evaluate(speeds)
        browser.evaluate(f"(s => {{ s.value = '1'; s.dispatchEvent(new Event('change')); }})({choice})")
        check(browser.evaluate(speeds) != first, "the times of the other reference's table")
        check("Noise of the reference: 210 % of the mean." in browser.evaluate("document.getElementById('results').textContent"),
              "the noise of the other reference")


def tells_lights_of_the_environment_apart(browser):
    """The same settings with the environment's light added up and by ratio: a curve and a line of frames per second for each."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    others = [json.loads(json.dumps(row)) for row in rows]
    for combine, those in (("add", rows), ("ratio", others)):
        for row in those:
            # Of one light alone, they would be another question.
            row.update(key=row["key"] + combine, light="", term="direct",
                       environment={"map": "sky", "lights": 0.015, "resolution": 48, "shape": "squares", "reflection": "area",
                                    "combine": combine})
            row.pop("penumbra", None)
    with reported([*rows, *others]):
        browser.open(page)
        names = browser.evaluate("[...document.querySelectorAll('.legend li')].map(l => l.textContent)")
        check(len(names) == 6 and len([name for name in names if name.endswith("ratio")]) == 3, f"the curves are {names}")
        lines = browser.evaluate("""[...document.querySelectorAll('#subject-0 table')]
            .find(t => t.caption.textContent.startsWith('Frames per second')).tBodies[0].rows.length""")
        check(lines == 2 * POINTS, f"{lines} lines of frames per second")


def draws_defaults_in_their_place(browser):
    """A curve runs from one value to the next, also where a row keeps the parameter's default."""
    row = [json.loads(line) for line in results.read_text().splitlines()][0]
    rows = []
    for i, size in enumerate((512, 2048, 1024, 4096)):  # the default is 1024 here, and 2048 comes before it
        rows.append(json.loads(json.dumps(row)))
        rows[i].update(key=f"size{size}", parameters={} if size == 1024 else {"hard_shadow_map.shadow_map_size": str(size)})
        rows[i]["stats"]["parameters"]["hard_shadow_map.shadow_map_size"] = str(size)
        rows[i]["stats"]["quality_parameters"] = ["hard_shadow_map.shadow_map_size"]
        rows[i]["stats"]["frame_ms"].update(median=size, q1=size, q3=size)
        rows[i]["stats"]["frame_samples_ms"] = [size, size]
    with reported(rows):
        browser.open(page)
        path = browser.evaluate("document.querySelector('svg.plot path.curve').getAttribute('d')")
        across = [float(point.split(",")[0]) for point in path.replace("M", "L").split("L")[1:]]
        check(len(across) == 4 and across == sorted(across), f"the curve is {path}")


def withstands_foreign_rows(browser):
    """Texts from elsewhere stay texts, failed rows and rows of earlier versions are shown, renderers never mix."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    hostile, failed, old, gpu = (json.loads(json.dumps(rows[0])) for _ in range(4))
    hostile.update(key="1", technique=HOSTILE, title=HOSTILE, light=HOSTILE, parameters={HOSTILE: HOSTILE},
                   picture=HOSTILE + ".png")
    hostile["stats"].update(renderer=HOSTILE, machine=HOSTILE, driver=HOSTILE, passes=[{"name": HOSTILE, "technique": HOSTILE}])
    failed.update(key="2", parameters={"hard_shadow_map.shadow_map_size": "64"}, failure=HOSTILE,
                  renderer=rows[0]["stats"]["renderer"])
    for key in ("spectrum", "penumbra", "picture", "difference"):
        old.pop(key)
    for key in ("passes", "shadow_maps", "driver", "machine", "lights", "quality_parameters"):
        old["stats"].pop(key, None)
    old["reference"].pop("noise_rms")
    old["error"].pop("noise_floor")
    old.update(key="3", technique="old", scene="of_an_earlier_version")
    gpu.update(key="4")
    gpu["stats"].update(renderer="A GPU", software=False)
    with results.open("a") as file:
        for row in (hostile, failed, old, gpu):
            file.write(json.dumps(row) + "\n")
    (out / "stress.json").write_text(json.dumps({"renderer": HOSTILE, "results": [
        None, {"technique": "pcss", "case": "without an answer", "answers": [None]},
        {"technique": "pcss", "case": "values alone", "allowed": 0, "answers": [
            {"term": "direct", "verdict": "pass", "error": 0.2, "benign": 0.1, "factor": 2}]},
        {"technique": "pcss", "case": "of an earlier version", "verdict": "pass", "error": 0.1, "factor": 1.5},
        {"technique": HOSTILE, "case": HOSTILE, "scene": HOSTILE, "answers": [
            {"term": HOSTILE, "verdict": "refused", "message": HOSTILE}, None,
            {"term": HOSTILE, "verdict": "pass", "error": 0.1, "benign": 0.1, "factor": 1}]}]}))
    limn("report", out)
    browser.open(page)
    check(browser.evaluate("document.querySelectorAll('#stability table').length") == 3, "no stability")
    cells = browser.evaluate("[...[...document.querySelectorAll('#stability details tr')]"
                             ".find(row => row.textContent.includes('values alone')).cells].map(cell => cell.textContent)")
    check(cells[-4:] == ["0.2", "0.1", "–", "–"], f"a case that only checks values shows {cells[-4:]}")
    check(browser.evaluate("window.harmed === undefined"), "a row's text ran")
    check(browser.evaluate("document.querySelectorAll('img[src=x], main script').length") == 0, "a row's text became markup")
    text = browser.evaluate("document.getElementById('results').innerText")
    for part in (HOSTILE, "failed: " + HOSTILE, "of_an_earlier_version", "hardware rendering", "software rendering"):
        check(part in text, f"{part!r} is not shown")
    measured = "[...document.querySelectorAll('.chooser')].filter(c => c.firstChild.textContent === 'Measured').length"
    check(browser.evaluate(measured) == 1, "software and hardware are not told apart")
    check(browser.evaluate("document.querySelector('#subject-0').querySelectorAll('g.point').length") == POINTS,
          "software and hardware share a chart")
    browser.evaluate("document.querySelector('#subject-0 tr[data-key=\"2\"] button').click()")
    check("Failed" in browser.evaluate("document.querySelector('#subject-0 .detail').textContent"), "the failed row is not shown")
    curves = "document.querySelectorAll('#subject-0 .spectrum .curve').length"
    check(browser.evaluate(curves) > 0, "no spectra beside the failed row")
    check(browser.evaluate(curves.replace(".curve'", ".curve.current'")) == 0, "another setting's spectrum is strong")

    results.write_text("")
    (out / "stress.json").unlink()
    limn("report", out)
    browser.open(page)
    check("No rows yet" in browser.evaluate("document.body.textContent"), "a report without rows")


def replaced(value, text):
    """The value with `text` in the place of every text and every parameter's name."""
    if isinstance(value, str):
        return text
    if isinstance(value, list):
        return [replaced(item, text) for item in value]
    if isinstance(value, dict):
        return {(text if key.startswith(("pcss.", "sampled_area_light.")) else key): replaced(item, text)
                for key, item in value.items()}
    return value


@contextlib.contextmanager
def listening():
    """An address on this machine, and the paths that were asked for there."""
    asked = []

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self):
            asked.append(self.path)
            self.send_response(204)
            self.end_headers()

        def log_message(self, *_):
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}", asked
    server.shutdown()


def shows_hostile_names_literally(browser):
    """Hostile texts in every field of every row: shown as they are, nothing runs, nothing is fetched."""
    rows = [json.loads(line) for line in results.read_text().splitlines()]
    with listening() as (address, asked):
        for number, text in enumerate(HOSTILE_TEXTS):
            text = text.replace("ADDRESS", address)
            hostile = [dict(replaced(row, text), key=str(i)) for i, row in enumerate(rows)]
            hostile.append(dict(hostile[0], key="failed", parameters={"failed": text}, failure=text, renderer=text))
            with reported([*rows, *hostile]):
                browser.open(page)
                what = f"hostile text {number}"
                for point in browser.evaluate("[...document.querySelectorAll('g.point')].slice(-2).map((p, i) => i)"):
                    browser.evaluate(f"[...document.querySelectorAll('g.point')].at(-1 - {point}).focus()")
                browser.settle()
                check(browser.evaluate("window.harmed === undefined"), f"{what} ran")
                check(browser.evaluate("document.querySelectorAll('main script, main link, main iframe, main svg svg').length") == 0,
                      f"{what} became markup")
                check(browser.evaluate("[...document.images].every(i => /^data:image\\/(png|webp);base64,/.test(i.src))"),
                      f"{what} became the address of a picture")
                check(browser.evaluate("[...document.links].every(l => l.getAttribute('href').startsWith('#'))"),
                      f"{what} became a link")
                literal = json.dumps(text)
                check(browser.evaluate(f"document.getElementById('results').textContent.includes({literal})"),
                      f"{what} is not shown as it is")
                check(browser.evaluate("document.documentElement.scrollWidth <= innerWidth"), f"{what} widens the page")
                check(not browser.problems, f"{what}: {browser.problems}")
        check(not asked, f"the page asked for {asked}")


def is_shut_by_its_policy(browser):
    """Even markup that came into the page could neither run nor ask for anything."""
    with listening() as (address, asked):
        browser.open(page)
        stopped = browser.evaluate(f"""(async () => {{
            const stopped = []; document.addEventListener('securitypolicyviolation', e => stopped.push(e.effectiveDirective));
            const put = (tag, set) => document.body.append(Object.assign(document.createElement(tag), set));
            put('script', {{textContent: 'window.harmed = true'}}); put('script', {{src: '{address}/script'}});
            put('style', {{textContent: 'body {{ color: red }}'}}); put('img', {{src: '{address}/image'}});
            put('iframe', {{src: '{address}/frame'}}); put('link', {{rel: 'stylesheet', href: '{address}/style'}});
            document.body.insertAdjacentHTML('beforeend', '<i onclick="window.harmed = true" style="color: red"></i>');
            document.querySelector('i').click();
            await fetch('{address}/fetch').catch(() => 0); try {{ new WebSocket('{address}'.replace('http', 'ws')); }} catch {{ }}
            await new Promise(done => setTimeout(done, 500)); return stopped; }})()""")
        check(browser.evaluate("window.harmed === undefined"), "a script without its hash runs")
        for directive in ("script-src-elem", "script-src-attr", "style-src-elem", "style-src-attr", "img-src", "connect-src",
                          "frame-src"):
            check(directive in stopped, f"the policy lets {directive} through: {stopped}")
        check(not asked, f"the page asked for {asked}")
        browser.problems.clear()  # what was stopped


bench()
with Browser(options.chromium) as browser:
    for step in (shows_points_and_pictures, reacts, is_resized, answers_for_a_budget, enlarges_and_flips, loads_pictures_on_demand,
                 tells_close_points_apart, is_painted, is_accessible, sets_the_reference_beside,
                 keeps_machines_and_programs_apart, tells_references_apart, tells_lights_of_the_environment_apart,
                 draws_defaults_in_their_place, shows_hostile_names_literally, is_shut_by_its_policy, withstands_foreign_rows):
        step(browser)
        check(not browser.problems, f"{step.__name__}: {browser.problems}")
print("the report page shows and does what it should")
