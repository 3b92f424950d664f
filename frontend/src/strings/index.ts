import { Signal } from "../signal";
import { browserStorage } from "../storage";
import { en, type Strings } from "./en";
import { zh } from "./zh";

export type Language = "en" | "zh";

const LANGUAGE_KEY = "linkwright.language";

function preferred(): Language {
  const chosen = browserStorage().getItem(LANGUAGE_KEY);
  if (chosen === "en" || chosen === "zh") return chosen;
  return navigator.language.toLowerCase().startsWith("zh") ? "zh" : "en";
}

export const language: Language = preferred();

/** The page's words in the user's language. */
export const strings: Strings = language === "zh" ? zh : en;

/** The page is about to be shown in another language. */
export const languageChosen = new Signal();

/** Remembers the choice and reloads the page. */
export function chooseLanguage(next: Language): void {
  browserStorage().setItem(LANGUAGE_KEY, next);
  languageChosen.emit();
  location.reload();
}
