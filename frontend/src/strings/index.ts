import { LANGUAGES, type Language } from "../protocol/languages";
import { takeRequested } from "../requested-settings";
import { Signal } from "../signal";
import { openBrowserStorage } from "../storage";
import { en, type Strings } from "./en";
import { zh } from "./zh";

export type { Language };

const TEXTS: Record<Language, Strings> = { en, zh };
const ALL = Object.keys(TEXTS) as Language[];
const FALLBACK = "en";
const LANGUAGE_KEY = "linkwright.language";

/** Returns the language of a locale's tag such as "zh-TW"; undefined if the page has no texts in it. */
function languageOf(tag: string): Language | undefined {
  return ALL.find((language) => language === tag.toLowerCase().split("-")[0]);
}

const requested = languageOf(takeRequested("language", globalThis.location, globalThis.history) ?? "");
if (requested) openBrowserStorage().setItem(LANGUAGE_KEY, requested);

export const language: Language =
  requested ?? languageOf(openBrowserStorage().getItem(LANGUAGE_KEY) ?? "") ?? languageOf(navigator.language) ?? FALLBACK;

/** The tag of the page's language, for the `lang` attribute of the document. */
export const languageTag: string = LANGUAGES[language];

/** The page's texts in the user's language. */
export const strings: Strings = TEXTS[language];

/** The page is about to be shown in another language. */
export const languageChosen = new Signal();

/** Stores the next language as the user's choice, and reloads the page in it. */
export function changeLanguage(): void {
  openBrowserStorage().setItem(LANGUAGE_KEY, ALL[ALL.indexOf(language) + 1] ?? FALLBACK);
  languageChosen.emit();
  location.reload();
}
