import type { BrowserStorage } from "../storage";

const PARAMETER = "token";
const STORAGE_KEY = "linkwright.token";

/** The address bar; `moveTo` replaces the address without loading it. */
export interface AddressBar {
  readonly href: string;
  moveTo(href: string): void;
}

/**
 * The tokens that the page may send to the server: the one in its address, and the last one that the server accepted
 * from a page of this browser. The browser's storage belongs to this host and port alone, so no other server receives
 * it.
 */
export class Tokens {
  private ownToken: string | null;
  private refusalCount = 0;

  constructor(
    private readonly address: AddressBar,
    private readonly storage: BrowserStorage,
  ) {
    this.ownToken = readToken(address.href);
  }

  /** The token to send next; the known tokens alternate after refusals. */
  get current(): string | null {
    const { knownTokens } = this;
    return knownTokens[this.refusalCount % Math.max(1, knownTokens.length)] ?? null;
  }

  /** Stores a token that the server accepted, and removes it from the address bar. */
  accept(token: string): void {
    const { address, storage } = this;
    this.use(token);
    storage.setItem(STORAGE_KEY, token);
    // Where the browser stores nothing, the token must stay in the address.
    const isStored = storage.isPersistent && storage.getItem(STORAGE_KEY) === token;
    if (isStored && readToken(address.href) !== null) address.moveTo(setToken(address.href, null));
  }

  /** Records that the current token was refused; returns whether another token remains to be tried. */
  refuse(): boolean {
    this.refusalCount += 1;
    return this.refusalCount < this.knownTokens.length;
  }

  /** Uses this token from now on. */
  use(token: string): void {
    this.ownToken = token;
    this.refusalCount = 0;
  }

  /** The address of this page for other users, with the token. */
  get link(): string {
    return setToken(this.address.href, this.current);
  }

  private get knownTokens(): string[] {
    const tokens = [this.ownToken, this.storage.getItem(STORAGE_KEY)].filter((token) => token !== null);
    return [...new Set(tokens)];
  }
}

/** Returns the token of an address within a text, or the text itself if it can be a token. */
export function extractToken(text: string): string | null {
  return /[?&]token=([\w-]+)/.exec(text)?.[1] ?? /^\s*([\w-]{16,})\s*$/.exec(text)?.[1] ?? null;
}

function readToken(href: string): string | null {
  return new URL(href).searchParams.get(PARAMETER);
}

function setToken(href: string, token: string | null): string {
  const url = new URL(href);
  if (token === null) url.searchParams.delete(PARAMETER);
  else url.searchParams.set(PARAMETER, token);
  return url.href;
}
