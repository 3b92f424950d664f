import { describe, expect, it } from "vitest";
import controls from "../src/styles/controls.css?raw";
import css from "../src/styles/theme.css?raw";

type Rgb = readonly [number, number, number];

/** Returns the variables of a rule, on top of those of the dark theme. */
function variables(selector: string): Map<string, string> {
  const found = new Map<string, string>();
  for (const name of [":root", selector]) {
    const start = css.indexOf(`${name} {`);
    const body = css.slice(start, css.indexOf("\n}", start));
    for (const [, key = "", value = ""] of body.matchAll(/(--[\w-]+):\s*([^;]+);/g)) found.set(key, value.trim());
  }
  return found;
}

function color(text: string | undefined, below: Rgb = [0, 0, 0]): Rgb {
  const hex = /^#(..)(..)(..)$/.exec(text ?? "");
  if (hex) return hex.slice(1).map((part) => parseInt(part, 16)) as unknown as Rgb;
  const mixed = /^rgb\((\d+) (\d+) (\d+) \/ (\d+)%\)$/.exec(text ?? "");
  if (!mixed) throw new Error(`no color: ${String(text)}`);
  const [r = 0, g = 0, b = 0, percent = 0] = mixed.slice(1).map(Number);
  const mix = (over: number, under: number): number => (over * percent + under * (100 - percent)) / 100;
  return [mix(r, below[0]), mix(g, below[1]), mix(b, below[2])];
}

function luminance(rgb: Rgb): number {
  const [r = 0, g = 0, b = 0] = rgb.map((part) => {
    const value = part / 255;
    return value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** WCAG 2's contrast ratio, 1 to 21. */
function contrast(one: Rgb, other: Rgb): number {
  const [dark = 0, light = 0] = [luminance(one), luminance(other)].sort((a, b) => a - b);
  return (light + 0.05) / (dark + 0.05);
}

const BACKGROUNDS = ["--bg-app", "--bg-panel", "--bg-bar", "--bg-raised", "--bg-hover", "--bg-field"];
const TEXTS = ["--text", "--text-soft", "--text-faint", "--accent", "--ok", "--warn", "--error", "--joint"];
const CODE = ["--xml-tag", "--xml-attribute", "--xml-value", "--xml-expression"];

describe.each([
  ["dark", ":root"],
  ["light", ':root[data-theme="light"]'],
])("the %s theme", (_, selector) => {
  const all = variables(selector);
  const at = (name: string, below?: Rgb): Rgb => color(all.get(name), below);

  it.each(TEXTS.flatMap((text) => BACKGROUNDS.map((background) => [text, background] as const)))(
    "%s on %s can be read (AA, 4.5)",
    (text, background) => {
      expect(contrast(at(text), at(background))).toBeGreaterThanOrEqual(4.5);
    },
  );

  it.each(CODE)("%s can be read in the source (AA, 4.5)", (text) => {
    expect(contrast(at(text), at("--bg-field"))).toBeGreaterThanOrEqual(4.5);
  });

  it("a selected row is readable", () => {
    const row = at("--accent-wash", at("--bg-panel"));
    for (const text of ["--text", "--text-soft", "--warn", "--error"]) {
      expect(contrast(at(text), row), text).toBeGreaterThanOrEqual(4.5);
    }
  });

  it("text on the accent color is readable", () => {
    expect(contrast(at("--text-on-accent"), at("--accent-deep"))).toBeGreaterThanOrEqual(4.5);
  });

  it("elements over the scene are readable over any content", () => {
    for (const scene of [[0, 0, 0], [48, 48, 48], [255, 255, 255]] as const) {
      expect(contrast(at("--text"), at("--bg-overlay", scene))).toBeGreaterThanOrEqual(4.5);
      expect(contrast(at("--text"), at("--bg-error", scene))).toBeGreaterThanOrEqual(4.5);
    }
  });

  it.each(["--accent", "--edge"])("%s, focus and edges of fields, boxes and sliders, can be seen (3)", (line) => {
    for (const background of BACKGROUNDS) expect(contrast(at(line), at(background)), background).toBeGreaterThanOrEqual(3);
  });

  it.each(["--thumb", "--thumb-hover"])("%s of a slider can be seen beside its panel (3)", (thumb) => {
    for (const background of BACKGROUNDS) expect(contrast(at(thumb), at(background)), background).toBeGreaterThanOrEqual(3);
  });

  it("edges of fields, boxes and sliders are visible", () => {
    for (const rule of [".field,\n.choice", ".check", ".slider::-moz-range-thumb", ".slider::-webkit-slider-thumb"]) {
      const start = controls.indexOf(`\n${rule} {`);
      expect(controls.slice(start, controls.indexOf("\n}", start)), rule).toMatch(/1px (solid )?var\(--edge\)/);
    }
  });
});
