/**
 * The settings that the address of a page can request, as in `?language=zh&theme=dark`. A page requests its own for the
 * pages in its frames.
 */
export type RequestedSetting = "language" | "theme";

/** Removes a requested setting from the address of the page, and returns it; null if it is not requested. */
export function takeRequested(setting: RequestedSetting, location: Location | undefined, history: History | undefined): string | null {
  if (!location || !history) return null;
  const address = new URL(location.href);
  const value = address.searchParams.get(setting);
  if (value === null) return null;
  address.searchParams.delete(setting);
  history.replaceState(history.state, "", address);
  return value;
}

/** Returns the address of a page with requested settings. */
export function addSettings(href: string, settings: Readonly<Record<RequestedSetting, string>>): string {
  const address = new URL(href);
  for (const [name, value] of Object.entries(settings)) address.searchParams.set(name, value);
  return address.href;
}
