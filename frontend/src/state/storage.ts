/** What the page remembers from visit to visit. */
export type TextStorage = Pick<Storage, "getItem" | "setItem">;

/** The browser's storage; where there is none, or the user forbids it, one that lasts as long as the page. */
export function browserStorage(): TextStorage {
  try {
    const { localStorage } = globalThis as { localStorage?: Storage };
    if (localStorage) return localStorage;
  } catch {
    // Forbidden by the browser's settings.
  }
  const texts = new Map<string, string>();
  return { getItem: (key) => texts.get(key) ?? null, setItem: (key, text) => void texts.set(key, text) };
}
