/** The storage for the page's settings. */
export type TextStorage = Pick<Storage, "getItem" | "setItem">;

export interface BrowserStorage extends TextStorage {
  removeItem(key: string): void;
  /** Whether the storage survives a reload of the page. */
  readonly isPersistent: boolean;
}

/**
 * Returns the browser's storage: across visits, or with `sessionStorage` while a tab is open. If there is none, or the
 * user forbids it, the storage lasts only while the page is open.
 */
export function openBrowserStorage(kind: "localStorage" | "sessionStorage" = "localStorage"): BrowserStorage {
  try {
    const storage = (globalThis as Partial<Record<typeof kind, Storage>>)[kind];
    if (storage) return createPersistentStorage(storage);
  } catch {
    // The browser's settings forbid it.
  }
  const texts = new Map<string, string>();
  return {
    isPersistent: false,
    getItem: (key) => texts.get(key) ?? null,
    setItem: (key, text) => void texts.set(key, text),
    removeItem: (key) => void texts.delete(key),
  };
}

function createPersistentStorage(storage: Storage): BrowserStorage {
  return {
    isPersistent: true,
    getItem: (key) => storage.getItem(key),
    setItem: (key, text) => {
      try {
        storage.setItem(key, text);
      } catch {
        // The storage is full.
      }
    },
    removeItem: (key) => storage.removeItem(key),
  };
}
