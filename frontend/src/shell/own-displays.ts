/** Displays of a page's own: `?displays=own` in its address asks for them. */
const PARAMETER = "displays";
const OWN = "own";
const KEY = "linkwright.own-displays";

export function hasOwnDisplays(address: string): boolean {
  return new URL(address).searchParams.get(PARAMETER) === OWN;
}

/** The address of the same page with displays of its own, or with those that all share. */
export function addressFor(address: string, own: boolean): string {
  const url = new URL(address);
  if (own) url.searchParams.set(PARAMETER, OWN);
  else url.searchParams.delete(PARAMETER);
  return url.href;
}

/** The key of this tab's own displays, so that they exist again after a reload. */
export function ownKey(storage: Pick<Storage, "getItem" | "setItem">): string {
  const known = storage.getItem(KEY);
  if (known !== null) return known;
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  const made = Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
  storage.setItem(KEY, made);
  return made;
}
