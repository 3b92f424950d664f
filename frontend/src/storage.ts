/** The storage of the page's settings. */
export type TextStorage = Pick<Storage, "getItem" | "setItem">;

export interface BrowserStorage extends TextStorage {
  removeItem(key: string): void;
  /** Whether it outlives a reload. */
  readonly lasts: boolean;
}

/**
 * The browser's storage from visit to visit, or with `sessionStorage` as long as a tab is open; where there is none, or
 * the user forbids it, one that lasts as long as the page.
 */
export function browserStorage(which: "localStorage" | "sessionStorage" = "localStorage"): BrowserStorage {
  try {
    const storage = (globalThis as Partial<Record<typeof which, Storage>>)[which];
    if (storage) return kept(storage);
  } catch {
    // Forbidden by the browser's settings.
  }
  const texts = new Map<string, string>();
  return {
    lasts: false,
    getItem: (key) => texts.get(key) ?? null,
    setItem: (key, text) => void texts.set(key, text),
    removeItem: (key) => void texts.delete(key),
  };
}

function kept(storage: Storage): BrowserStorage {
  return {
    lasts: true,
    getItem: (key) => storage.getItem(key),
    setItem: (key, text) => {
      try {
        storage.setItem(key, text);
      } catch {
        // It is full.
      }
    },
    removeItem: (key) => storage.removeItem(key),
  };
}
