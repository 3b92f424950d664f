import { expect, it } from "vitest";
import { DISPLAY_PATHS } from "../src/icons/displays";
import { en } from "../src/strings/en";
import { zh } from "../src/strings/zh";

type Words = Readonly<Record<string, unknown>>;

/** Returns the path and type of every text. */
function* words(part: Words, path = ""): Generator<[string, unknown]> {
  for (const [name, value] of Object.entries(part)) {
    if (typeof value === "object" && value !== null && !Array.isArray(value)) yield* words(value as Words, `${path}${name}.`);
    else yield [`${path}${name}`, value];
  }
}

const english = new Map(words(en));
const chinese = new Map(words(zh));

/** RViz's names of tools and of values, which need no translation in English. */
const OTHERS_ONLY = ["tools.names.", "values."];

it("the languages have the same texts", () => {
  const common = (paths: Iterable<string>): string[] => [...paths].filter((path) => !OTHERS_ONLY.some((each) => path.startsWith(each))).sort();
  expect(common(chinese.keys())).toEqual(common(english.keys()));
  for (const [path, word] of english) expect(typeof chinese.get(path), path).toBe(typeof word);
});

it("no text is empty, and Chinese ones are Chinese", () => {
  const latin: string[] = [];
  for (const [path, word] of chinese) {
    if (typeof word !== "string") continue;
    if (english.get(path) !== "") expect(word.trim(), path).not.toBe("");
    if (word === english.get(path) && /[a-z]{4}/.test(word)) latin.push(path);
  }
  // Names of RViz and ROS that are English in any language.
  expect(latin.length).toBeLessThan(25);
});

it("every display with an icon has a description", () => {
  expect(Object.keys(en.displays.about).sort()).toEqual(Object.keys(DISPLAY_PATHS).sort());
});
