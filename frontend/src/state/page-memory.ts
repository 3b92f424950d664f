import { PROTOCOL_VERSION } from "../protocol";
import type { BrowserStorage } from "../storage";

/**
 * The storage key; it contains the version of the protocol, so that state from another version of the page is ignored.
 */
const STORAGE_KEY = `linkwright.kept.${PROTOCOL_VERSION}`;

/** State that survives the reload of the page when the user chooses another language. */
export class PageMemory {
  private readonly parts = new Map<string, () => unknown>();
  private readonly previous: Readonly<Record<string, unknown>>;

  constructor(private readonly storage: Omit<BrowserStorage, "lasts">) {
    this.previous = JSON.parse(storage.getItem(STORAGE_KEY) ?? "{}") as Record<string, unknown>;
    storage.removeItem(STORAGE_KEY);
  }

  /**
   * Registers a part of the state: calls `restore` with the previous page's value of this name, if any, and `read` when
   * this page is left.
   */
  preserve<T>(name: string, read: () => T, restore: (value: T) => void): void {
    this.parts.set(name, read);
    if (name in this.previous) restore(this.previous[name] as T);
  }

  /** Stores all parts, because the page is about to be reloaded. */
  store(): void {
    this.storage.setItem(STORAGE_KEY, JSON.stringify(Object.fromEntries([...this.parts].map(([name, read]) => [name, read()]))));
  }
}
