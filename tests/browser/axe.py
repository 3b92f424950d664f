"""Findings of axe-core in a page: the machine-checked rules of WCAG 2.1, levels A and AA.

axe-core does not decide a contrast in front of an image. So the scene is replaced by one color, the worst one for the
texts over it, and the arrows of selects and the contents of ``::before`` and ``::after``, which are lines and marks
beside texts, are hidden. Contrasts that are still undecided, such as those of texts in drawings, are computed here. The
labels of the axes belong to the scene: they are hidden from assistive technology (``aria-hidden``), and their colors
identify the axes.
"""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import Page

SCRIPT = Path(__file__).parents[2] / "frontend" / "node_modules" / "axe-core" / "axe.min.js"
"""A development dependency of the page (MPL-2.0), which no package of Linkwright contains."""
THEMES = {"dark": "#ffffff", "light": "#000000"}
"""The page's themes, and the scene's color with the worst contrast for each."""

_PREPARE = """
const plain = new CSSStyleSheet();
plain.replaceSync(`
  * { transition: none !important; animation: none !important; }
  *::before, *::after { content: none !important; }
  select { background-image: none !important; }
  .canvas-box { visibility: hidden; }
  .scene-box { background: var(--worst) !important; }`);
document.adoptedStyleSheets.push(plain);

const numbers = (color) => {
  const [red, green, blue, alpha = 1] = color === "none" ? [0, 0, 0, 0] : color.match(/[\\d.]+/g).map(Number);
  const most = color.startsWith("color(srgb") ? 255 : 1;  // what color-mix() makes
  return [red * most, green * most, blue * most, alpha];
};
const over = (color, paper) => {
  const [red, green, blue, alpha] = numbers(color);
  return [red, green, blue].map((value, i) => alpha * value + (1 - alpha) * paper[i]);
};
const behind = (element) => {
  if (!element) return [255, 255, 255];
  const box = element instanceof SVGGElement && element.querySelector("rect, ellipse");
  const style = getComputedStyle(box || element);
  return over(box ? style.fill : style.backgroundColor, behind(element.parentElement));
};
window.contrastOf = (element) => {
  const drawn = element instanceof SVGElement;
  // The origin of a joint stands above its box, not in it.
  const paper = behind(element.matches(".origin") ? element.closest("svg") : element);
  const style = getComputedStyle(element);
  const light = [over(drawn ? style.fill : style.color, paper), paper]
    .map((color) => new axe.commons.color.Color(...color).getRelativeLuminance());
  return (Math.max(...light) + 0.05) / (Math.min(...light) + 0.05);
};
// Where axe-core loses its way between lists that are scrolled, it judges no text at all.
window.texts = (selector) => [...document.querySelectorAll(`${selector ?? "body"} *`)]
  .filter(({ childNodes }) => [...childNodes].some(({ nodeType, data }) => nodeType === 3 && data.trim() !== ""))
  .filter((element) => element.checkVisibility() && !element.closest(".orientation, :disabled, [aria-disabled=true]"))
  .map((element) => ({ element, html: element.outerHTML, target: [element.className], any: [], all: [], none: [] }));
null
"""
_RUN = """async ([selector, worst]) => {
  document.documentElement.style.setProperty("--worst", worst);
  const rules = { type: "tag", values: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa"] };
  const context = { include: selector ?? document, exclude: ".orientation" };
  const { violations, incomplete } = await axe.run(context, { runOnly: rules, elementRef: true });
  const undecided = incomplete.filter(({ id }) => id === "color-contrast").flatMap((rule) => ({
    ...rule,
    nodes: (rule.error ? texts(selector) : rule.nodes).filter(({ element }) => contrastOf(element) < 4.5),
  }));
  return [...violations, ...undecided].flatMap(({ id, nodes }) => nodes.map(({ target, html, any, all, none }) =>
    [`${id}: ${target}`, html.slice(0, 200), ...any.concat(all, none).map(({ message }) => message)].join("\\n  ")));
}"""


def find_violations(page: Page, selector: str | None = None) -> list[str]:
    """Return the violations in the page or in one of its elements, in dark and in light colors.

    Raises:
        FileNotFoundError: the page's development packages are not installed (``npm ci`` in ``frontend/``).
    """
    if not page.evaluate("() => 'contrastOf' in window"):
        page.evaluate(SCRIPT.read_text(encoding="utf-8") + _PREPARE)
    found_violations = []
    for theme, darkest in THEMES.items():
        page.emulate_media(color_scheme=theme)
        page.wait_for_function("theme => document.documentElement.dataset.theme === theme", arg=theme)
        found_violations += [f"{theme}: {violation}" for violation in page.evaluate(_RUN, [selector, darkest])]
    return found_violations
