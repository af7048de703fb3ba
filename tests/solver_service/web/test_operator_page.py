"""The operator's page: its files, and what a person sees and does in a real browser."""

import json
import re
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

import protocol
from bench.service_process import ServiceClient, ServiceProcess
from solver_service.web.operator_page import FOLDER
from solver_service.web.scopes import Scope
from solver_service.web.token_store import TokenStore
from tests.solver_service.web.browser import Browser, find_browser

browser = pytest.mark.skipif(
    find_browser() is None, reason="there is no browser; ./fev libraries test installs one"
)
HARM = "<img src=x onerror=\"document.title='harmed'\"><script>document.title='harmed'</script>"


@pytest.fixture(scope="module")
def runs(service: ServiceProcess) -> Iterator[tuple[ServiceClient, str, str]]:
    """A viewer that controls a long run and watches its child, whose name is markup."""
    with ServiceClient(service) as viewer:
        parent = viewer.do(protocol.StartRun, case="dam-break", duration=1e6)["run"]
        viewer.do(protocol.Subscribe, run=parent)
        viewer.frame(parent, 1)
        child = viewer.do(protocol.Recalculate, run=parent, index=1, revision=0)["run"]
        viewer.do(protocol.RenameRun, run=child, label=HARM)
        viewer.do(protocol.Unsubscribe)
        yield viewer, parent, child
    headers = {"Authorization": f"Bearer {service.token}"}
    for run in (child, parent):
        httpx.post(f"{service.http}/v1/runs/{run}/stop", headers=headers)


@pytest.fixture(scope="module")
def page(service: ServiceProcess, runs: tuple[ServiceClient, str, str]) -> Iterator[Browser]:
    """The page, signed in by keyboard."""
    with Browser() as opened:
        opened.open(f"{service.http}/")
        opened.until("document.activeElement.id === 'token'")
        opened.type(service.token)
        opened.press("Enter")
        opened.until(f"document.querySelector('tr[data-id={runs[2]}]') !== null")
        yield opened
        assert [message for message in opened.messages if '"network"' not in message] == []


def test_the_files_are_served_with_a_policy_that_allows_nothing_from_elsewhere(
    service: ServiceProcess,
) -> None:
    for path, kind in (("/", "text/html"), ("/page.css", "text/css"), ("/page.js", "text/javascript")):
        answer = httpx.get(f"{service.http}{path}")
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith(kind)
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
        assert "frame-ancestors 'none'" in policy
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert not re.search(r"https?://|//[a-z]+\.", answer.text.replace("// ", "")), path


def test_the_script_makes_no_markup_of_texts() -> None:
    script = (FOLDER / "page.js").read_text(encoding="utf-8")
    assert not re.search(
        r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(|new Function", script
    )
    assert "localStorage" not in script
    assert not re.search(r"[?&]token=", script)


@browser
def test_a_wrong_token_and_one_of_a_viewer_are_refused_in_words(service: ServiceProcess) -> None:
    store = TokenStore(service.data_dir)
    viewer, _ = store.create("guest", Scope.VIEWER, None)
    store.close()
    with Browser() as page:
        page.open(f"{service.http}/")
        for token, words in (
            ("wrong-token-of-sixteen", "token that holds"),
            (viewer, "needs the scope operator"),
        ):
            page.until("document.activeElement.id === 'token'")
            page.type(token)
            page.press("Enter")
            page.until(f"document.getElementById('token-error').textContent.includes({json.dumps(words)})")
            assert page.value("sessionStorage.length") == 0
            assert page.value("document.getElementById('board').hidden")
        assert "token" not in page.value("location.href")


@browser
def test_runs_are_shown_as_a_tree_with_their_facts_and_names_stay_text(
    page: Browser, runs: tuple[ServiceClient, str, str]
) -> None:
    _, parent, child = runs
    order = page.value("[...document.querySelectorAll('#runs tbody tr')].map((row) => row.dataset.id)")
    assert order.index(child) == order.index(parent) + 1
    assert page.value(f"document.querySelector('tr[data-id={child}] th').className") == "depth-1"
    page.until(f"document.querySelector('tr[data-id={child}] .name').textContent === {json.dumps(HARM)}")
    assert page.value("document.querySelectorAll('#board img, #board script').length") == 0
    assert page.value("document.title") == "FEV solver service"
    page.until(f"document.querySelector('tr[data-id={child}]').innerText.includes(' x')")
    assert "running" in page.text(f"tr[data-id={child}]")
    assert "fev-bench" in page.text(f"tr[data-id={child}]")
    assert "cpu" in page.text("#devices")
    assert "token file" in page.text("#connections")
    assert page.text("#link") == "live"
    assert "Memory" in page.text("#glance")


@browser
def test_the_memory_of_a_gpu_has_a_tile_of_its_own(page: Browser) -> None:
    gpu = {
        "index": 0,
        "name": "A <b>big</b> one",
        "used_bytes": 12_000_000_000,
        "total_bytes": 140_000_000_000,
    }
    news = {"set": {"gpus": {"0": gpu}}, "gone": {}}
    told = "[...document.querySelectorAll('#glance > div')].map((tile) => tile.innerText).join()"
    assert "GPU" not in page.value(told)
    shown = page.value(f"take('overview', {json.dumps(json.dumps(news))}), {told}")
    assert re.search(r"GPU 0\s+12.GB\s+of 140.GB, A <b>big</b> one", shown), shown
    page.value(f"take('overview', {json.dumps(json.dumps({'set': {}, 'gone': {'gpus': ['0']}}))})")
    assert "GPU" not in page.value(told)


@browser
def test_an_action_asks_first_and_then_acts(
    service: ServiceProcess, page: Browser, runs: tuple[ServiceClient, str, str]
) -> None:
    _, _, child = runs
    headers = {"Authorization": f"Bearer {service.token}"}

    def status() -> str:
        return str(httpx.get(f"{service.http}/v1/runs/{child}", headers=headers).json()["status"])

    page.click(f"tr[data-id={child}] [data-action=pause]")
    page.until("document.getElementById('confirm').open")
    assert "Pause run" in page.text("#confirm-text")
    assert page.value("document.activeElement.id") == "confirm-no"
    page.press("Enter")  # the safe answer has the focus
    page.until("!document.getElementById('confirm').open")
    assert status() == "running"
    page.click(f"tr[data-id={child}] [data-action=pause]")
    page.click("#confirm-yes")
    page.until(f"document.querySelector('tr[data-id={child}] .badge').textContent === 'paused'")
    assert status() == "paused"
    page.until("document.getElementById('answer').textContent.endsWith('pause: done')")
    page.click(f"tr[data-id={child}] [data-action=resume]")
    page.until(f"document.querySelector('tr[data-id={child}] .badge').textContent === 'running'")
    page.click(f"tr[data-id={child}] [data-action=stop]")
    page.click("#confirm-yes")
    page.until(f"document.querySelector('tr[data-id={child}] .badge').textContent === 'stopped'")
    assert status() == "stopped"


@browser
def test_a_refused_action_is_told(page: Browser, runs: tuple[ServiceClient, str, str]) -> None:
    _, parent, _ = runs
    page.click(f"tr[data-id={parent}] [data-action=delete]")
    page.click("#confirm-yes")
    page.until("document.getElementById('answer').textContent.includes('holds the past of')")


@browser
def test_every_table_has_headers_and_every_control_a_name(page: Browser) -> None:
    assert page.value("[...document.querySelectorAll('th')].every((cell) => cell.scope)")
    named = "(one) => (one.getAttribute('aria-label') || one.innerText).trim()"
    controls = "[...document.querySelectorAll('#board button, #board progress, header button')]"
    assert page.value(f"{controls}.every({named})")
    assert page.value("[...document.querySelectorAll('[aria-live]')].length") >= 3
    assert page.value("document.documentElement.lang") == "en"


@browser
@pytest.mark.parametrize("dark", [False, True])
def test_texts_have_a_contrast_of_four_and_a_half_on_a_phone_that_needs_no_sideways_scroll(
    service: ServiceProcess, runs: tuple[ServiceClient, str, str], tmp_path: Path, dark: bool
) -> None:
    with Browser(390, 800, dark, mobile=True) as phone:
        phone.open(f"{service.http}/")
        phone.until("document.activeElement.id === 'token'")
        phone.type(service.token)
        phone.press("Enter")
        phone.until("document.querySelectorAll('#runs tbody tr').length >= 2")
        assert phone.value("document.documentElement.scrollWidth") <= 390
        worst = phone.value(CONTRAST)
        assert worst[0] >= 4.5, worst
        phone.picture(tmp_path / "phone.png")
        assert (tmp_path / "phone.png").stat().st_size > 20_000


@browser
def test_a_service_that_goes_away_is_told_and_what_was_seen_stays(tmp_path: Path) -> None:
    with ServiceProcess(tmp_path / "data", spare_workers=0) as gone, Browser() as page:
        page.open(f"{gone.http}/")
        page.until("document.activeElement.id === 'token'")
        page.type(gone.token)
        page.press("Enter")
        page.until("document.getElementById('glance').children.length > 0")
        gone.stop()
        page.until("document.getElementById('link').textContent.includes('connection lost')")
        assert "trying again" in page.text("#link")
        assert page.value("document.getElementById('board').classList.contains('stale')")
        assert page.value("document.getElementById('glance').children.length") > 0


CONTRAST = """
(() => {
  const light = (text) => {
    const parts = text.match(/[\\d.]+/g).map(Number);
    const [r, g, b] = parts.slice(0, 3).map((part) => {
      const share = part / 255;
      return share <= 0.03928 ? share / 12.92 : ((share + 0.055) / 1.055) ** 2.4;
    });
    return { value: 0.2126 * r + 0.7152 * g + 0.0722 * b, alpha: parts[3] ?? 1 };
  };
  const ground = (one) => {
    for (let at = one; at; at = at.parentElement) {
      const found = light(getComputedStyle(at).backgroundColor);
      if (found.alpha === 1) return found.value;
    }
    return 1;
  };
  let worst = [21, ""];
  for (const one of document.querySelectorAll("body *")) {
    const own = [...one.childNodes].some((child) => child.nodeType === 3 && child.textContent.trim());
    if (!own || !one.offsetParent || one.disabled) continue;
    const ink = light(getComputedStyle(one).color).value;
    const paper = ground(one);
    const ratio = (Math.max(ink, paper) + 0.05) / (Math.min(ink, paper) + 0.05);
    if (ratio < worst[0]) worst = [ratio, `${one.tagName}.${one.className}: ${one.textContent.slice(0, 40)}`];
  }
  return worst;
})()
"""
