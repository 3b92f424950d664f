import { language } from "../../strings";

/** Returns a text of a course in the page's language, or in the first one that it has. */
export function localText(texts: Readonly<Record<string, string>>): string {
  return texts[language] ?? Object.values(texts)[0] ?? "";
}
