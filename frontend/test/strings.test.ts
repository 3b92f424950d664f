import { expect, it } from "vitest";
import { DISPLAY_ICON_PATHS } from "../src/icons/displays";
import { en } from "../src/strings/en";
import { zh } from "../src/strings/zh";

type Texts = Readonly<Record<string, unknown>>;

/** Returns the path and type of every text. */
function* listTexts(part: Texts, path = ""): Generator<[string, unknown]> {
  for (const [name, value] of Object.entries(part)) {
    if (typeof value === "object" && value !== null && !Array.isArray(value)) yield* listTexts(value as Texts, `${path}${name}.`);
    else yield [`${path}${name}`, value];
  }
}

const englishTexts = new Map(listTexts(en));
const chineseTexts = new Map(listTexts(zh));

/** RViz's names of tools and of values, which need no translation in English. */
const TRANSLATED_ONLY = ["tools.names.", "values."];

it("the languages have the same texts", () => {
  const selectCommon = (paths: Iterable<string>): string[] => [...paths].filter((path) => !TRANSLATED_ONLY.some((prefix) => path.startsWith(prefix))).sort();
  expect(selectCommon(chineseTexts.keys())).toEqual(selectCommon(englishTexts.keys()));
  for (const [path, text] of englishTexts) expect(typeof chineseTexts.get(path), path).toBe(typeof text);
});

it("no text is empty, and Chinese ones are Chinese", () => {
  const untranslatedPaths: string[] = [];
  for (const [path, text] of chineseTexts) {
    if (typeof text !== "string") continue;
    if (englishTexts.get(path) !== "") expect(text.trim(), path).not.toBe("");
    if (text === englishTexts.get(path) && /[a-z]{4}/.test(text)) untranslatedPaths.push(path);
  }
  // Names of RViz and ROS that are English in any language.
  expect(untranslatedPaths.length).toBeLessThan(25);
});

it("every display with an icon has a description", () => {
  expect(Object.keys(en.displays.about).sort()).toEqual(Object.keys(DISPLAY_ICON_PATHS).sort());
});
