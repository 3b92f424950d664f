import { PROTOCOL_VERSION } from "../protocol";
import type { BrowserStorage } from "../storage";

/**
 * The storage key; it contains the version of the protocol, so that state from another version of the page is ignored.
 */
const KEY = `linkwright.kept.${PROTOCOL_VERSION}`;

/** State that survives the reload of the page when the user chooses another language. */
export class Kept {
  private readonly parts = new Map<string, () => unknown>();
  private readonly found: Readonly<Record<string, unknown>>;

  constructor(private readonly storage: Omit<BrowserStorage, "lasts">) {
    this.found = JSON.parse(storage.getItem(KEY) ?? "{}") as Record<string, unknown>;
    storage.removeItem(KEY);
  }

  /**
   * Registers a part of the state: calls `restore` with the previous page's value of this name, if any, and `read` when
   * this page is left.
   */
  part<T>(name: string, read: () => T, take: (value: T) => void): void {
    this.parts.set(name, read);
    if (name in this.found) take(this.found[name] as T);
  }

  /** Stores all parts, because the page is about to be reloaded. */
  leave(): void {
    this.storage.setItem(KEY, JSON.stringify(Object.fromEntries([...this.parts].map(([name, read]) => [name, read()]))));
  }
}
