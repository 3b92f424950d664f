import { describe, expect, it } from "vitest";
import controls from "../src/styles/controls.css?raw";
import css from "../src/styles/theme.css?raw";

type Rgb = readonly [number, number, number];

/** Returns the variables of a rule, on top of those of the dark theme. */
function readVariables(selector: string): Map<string, string> {
  const variables = new Map<string, string>();
  for (const name of [":root", selector]) {
    const start = css.indexOf(`${name} {`);
    const body = css.slice(start, css.indexOf("\n}", start));
    for (const [, key = "", value = ""] of body.matchAll(/(--[\w-]+):\s*([^;]+);/g)) variables.set(key, value.trim());
  }
  return variables;
}

function parseColor(text: string | undefined, background: Rgb = [0, 0, 0]): Rgb {
  const hex = /^#(..)(..)(..)$/.exec(text ?? "");
  if (hex) return hex.slice(1).map((part) => parseInt(part, 16)) as unknown as Rgb;
  const mixed = /^rgb\((\d+) (\d+) (\d+) \/ (\d+)%\)$/.exec(text ?? "");
  if (!mixed) throw new Error(`no color: ${String(text)}`);
  const [r = 0, g = 0, b = 0, percent = 0] = mixed.slice(1).map(Number);
  const mix = (over: number, under: number): number => (over * percent + under * (100 - percent)) / 100;
  return [mix(r, background[0]), mix(g, background[1]), mix(b, background[2])];
}

function computeLuminance(rgb: Rgb): number {
  const [r = 0, g = 0, b = 0] = rgb.map((part) => {
    const value = part / 255;
    return value <= 0.03928 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

/** WCAG 2's contrast ratio, 1 to 21. */
function computeContrast(first: Rgb, second: Rgb): number {
  const [darker = 0, lighter = 0] = [computeLuminance(first), computeLuminance(second)].sort((a, b) => a - b);
  return (lighter + 0.05) / (darker + 0.05);
}

const BACKGROUNDS = ["--bg-app", "--bg-panel", "--bg-bar", "--bg-raised", "--bg-hover", "--bg-field"];
const TEXTS = ["--text", "--text-soft", "--text-faint", "--accent", "--ok", "--warn", "--error", "--joint"];
const CODE = ["--xml-tag", "--xml-attribute", "--xml-value", "--xml-expression"];

describe.each([
  ["dark", ":root"],
  ["light", ':root[data-theme="light"]'],
])("the %s theme", (_, selector) => {
  const variables = readVariables(selector);
  const colorOf = (name: string, background?: Rgb): Rgb => parseColor(variables.get(name), background);

  it.each(TEXTS.flatMap((text) => BACKGROUNDS.map((background) => [text, background] as const)))(
    "%s on %s can be read (AA, 4.5)",
    (text, background) => {
      expect(computeContrast(colorOf(text), colorOf(background))).toBeGreaterThanOrEqual(4.5);
    },
  );

  it.each(CODE)("%s can be read in the source (AA, 4.5)", (text) => {
    expect(computeContrast(colorOf(text), colorOf("--bg-field"))).toBeGreaterThanOrEqual(4.5);
  });

  it("a selected row is readable", () => {
    const row = colorOf("--accent-wash", colorOf("--bg-panel"));
    for (const text of ["--text", "--text-soft", "--warn", "--error"]) {
      expect(computeContrast(colorOf(text), row), text).toBeGreaterThanOrEqual(4.5);
    }
  });

  it("text on the accent color is readable", () => {
    expect(computeContrast(colorOf("--text-on-accent"), colorOf("--accent-deep"))).toBeGreaterThanOrEqual(4.5);
  });

  it("elements over the scene are readable over any content", () => {
    for (const scene of [[0, 0, 0], [48, 48, 48], [255, 255, 255]] as const) {
      expect(computeContrast(colorOf("--text"), colorOf("--bg-overlay", scene))).toBeGreaterThanOrEqual(4.5);
      expect(computeContrast(colorOf("--text"), colorOf("--bg-error", scene))).toBeGreaterThanOrEqual(4.5);
    }
  });

  it.each(["--accent", "--edge"])("%s, focus and edges of fields, boxes and sliders, can be seen (3)", (line) => {
    for (const background of BACKGROUNDS) expect(computeContrast(colorOf(line), colorOf(background)), background).toBeGreaterThanOrEqual(3);
  });

  it.each(["--thumb", "--thumb-hover"])("%s of a slider can be seen beside its panel (3)", (thumb) => {
    for (const background of BACKGROUNDS) expect(computeContrast(colorOf(thumb), colorOf(background)), background).toBeGreaterThanOrEqual(3);
  });

  it("edges of fields, boxes and sliders are visible", () => {
    for (const rule of [".field,\n.choice", ".check", ".slider::-moz-range-thumb", ".slider::-webkit-slider-thumb"]) {
      const start = controls.indexOf(`\n${rule} {`);
      expect(controls.slice(start, controls.indexOf("\n}", start)), rule).toMatch(/1px (solid )?var\(--edge\)/);
    }
  });
});
