/** The parameter of the page's address that requests displays of its own: `?displays=own`. */
const PARAMETER = "displays";
const OWN_VALUE = "own";
const STORAGE_KEY = "linkwright.own-displays";

export function hasOwnDisplays(address: string): boolean {
  return new URL(address).searchParams.get(PARAMETER) === OWN_VALUE;
}

/** Returns the address of the page with displays of its own, or with the shared ones. */
export function addressFor(address: string, isOwn: boolean): string {
  const url = new URL(address);
  if (isOwn) url.searchParams.set(PARAMETER, OWN_VALUE);
  else url.searchParams.delete(PARAMETER);
  return url.href;
}

/** Returns the key that identifies this tab's own displays, also after a reload; creates it on the first call. */
export function ensureOwnKey(storage: Pick<Storage, "getItem" | "setItem">): string {
  const storedKey = storage.getItem(STORAGE_KEY);
  if (storedKey !== null) return storedKey;
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const key = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  storage.setItem(STORAGE_KEY, key);
  return key;
}
