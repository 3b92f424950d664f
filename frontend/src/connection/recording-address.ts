/** The parameter of the page's address that names a recording to show instead of live data. */
const PARAMETER = "recording";

/** Returns the recording that an address names, or null. */
export function readRecordingName(address: string): string | null {
  return new URL(address).searchParams.get(PARAMETER);
}

/** Returns the address of the page of a recording, or of the live page if the recording is null. */
export function setRecordingName(address: string, recording: string | null): string {
  const url = new URL(address);
  if (recording === null) url.searchParams.delete(PARAMETER);
  else url.searchParams.set(PARAMETER, recording);
  return url.href;
}
