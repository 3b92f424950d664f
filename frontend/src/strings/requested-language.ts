/** The parameter of the page's address that requests a language: `?language=zh`. */
const PARAMETER = "language";

/** Removes the requested language from the page's address, and returns it; null if none is requested. */
export function takeRequestedLanguage(location: Location | undefined, history: History | undefined): string | null {
  if (!location || !history) return null;
  const address = new URL(location.href);
  const requested = address.searchParams.get(PARAMETER);
  if (requested === null) return null;
  address.searchParams.delete(PARAMETER);
  history.replaceState(history.state, "", address);
  return requested;
}

/** Returns the address of a page in a language. */
export function withLanguage(href: string, language: string): string {
  const address = new URL(href);
  address.searchParams.set(PARAMETER, language);
  return address.href;
}
