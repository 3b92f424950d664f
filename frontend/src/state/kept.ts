import { PROTOCOL_VERSION } from "../protocol";
import type { BrowserStorage } from "../storage";

/** Of another version of the page nothing is taken. */
const KEY = `linkwright.kept.${PROTOCOL_VERSION}`;

/** What a page shows by itself, for the one that takes its place when the user chooses another language. */
export class Kept {
  private readonly parts = new Map<string, () => unknown>();
  private readonly found: Readonly<Record<string, unknown>>;

  constructor(private readonly storage: Omit<BrowserStorage, "lasts">) {
    this.found = JSON.parse(storage.getItem(KEY) ?? "{}") as Record<string, unknown>;
    storage.removeItem(KEY);
  }

  /** Gives `take` what the page before had under a name, if there was one, and asks `read` when this page is left. */
  part<T>(name: string, read: () => T, take: (value: T) => void): void {
    this.parts.set(name, read);
    if (name in this.found) take(this.found[name] as T);
  }

  /** The page is about to be shown anew. */
  leave(): void {
    this.storage.setItem(KEY, JSON.stringify(Object.fromEntries([...this.parts].map(([name, read]) => [name, read()]))));
  }
}
