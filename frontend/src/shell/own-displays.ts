/** The parameter of the page's address that requests displays of its own: `?displays=own`. */
const PARAMETER = "displays";
const OWN = "own";
const KEY = "linkwright.own-displays";

export function hasOwnDisplays(address: string): boolean {
  return new URL(address).searchParams.get(PARAMETER) === OWN;
}

/** Returns the address of the page with displays of its own, or with the shared ones. */
export function addressFor(address: string, own: boolean): string {
  const url = new URL(address);
  if (own) url.searchParams.set(PARAMETER, OWN);
  else url.searchParams.delete(PARAMETER);
  return url.href;
}

/** Returns the key of this tab's own displays, which identifies them again after a reload. */
export function ownKey(storage: Pick<Storage, "getItem" | "setItem">): string {
  const known = storage.getItem(KEY);
  if (known !== null) return known;
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const name = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  storage.setItem(KEY, name);
  return name;
}
