/** Where meshes, and what these name, come from. */
export interface MeshFiles {
  /** The file with an address of the server. */
  fetch(url: string): Promise<Response>;
  /** What the browser can load in place of such an address. */
  address(url: string): string;
}

/** From the server. It is asked every time whether the file is still the same. */
export const SERVED: MeshFiles = {
  fetch: (url) => fetch(url, { cache: "no-cache", credentials: "same-origin" }),
  address: (url) => url,
};
