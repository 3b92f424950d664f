import { language } from "../../strings";

/** Returns a text of a course in the page's language, or in its first language. */
export function localize(texts: Readonly<Record<string, string>>): string {
  return texts[language] ?? Object.values(texts)[0] ?? "";
}
