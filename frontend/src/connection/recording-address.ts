/** A recording that this page shows instead of the program's present: `?recording=` in its address names it. */
const PARAMETER = "recording";

/** The recording that an address names; null for none. */
export function recordingIn(address: string): string | null {
  return new URL(address).searchParams.get(PARAMETER);
}

/** The address of the page of a recording, or of the program's own page. */
export function addressOf(address: string, recording: string | null): string {
  const url = new URL(address);
  if (recording === null) url.searchParams.delete(PARAMETER);
  else url.searchParams.set(PARAMETER, recording);
  return url.href;
}
