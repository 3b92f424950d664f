/** The source of meshes and of the files that they refer to. */
export interface MeshFiles {
  /** Fetches the file at an address of the server. */
  fetch(url: string): Promise<Response>;
  /** Returns the address from which the browser loads the file. */
  addressOf(url: string): string;
}

/** The files of the server; each fetch checks whether the file has changed. */
export const SERVER_FILES: MeshFiles = {
  fetch: (url) => fetch(url, { cache: "no-cache", credentials: "same-origin" }),
  addressOf: (url) => url,
};
