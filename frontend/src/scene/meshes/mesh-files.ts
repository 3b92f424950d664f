/** The source of meshes, and of the files that they name. */
export interface MeshFiles {
  /** The file with an address of the server. */
  fetch(url: string): Promise<Response>;
  /** The address that the browser loads for it. */
  address(url: string): string;
}

/** The files of the server. It is asked every time whether the file is still the same. */
export const SERVED: MeshFiles = {
  fetch: (url) => fetch(url, { cache: "no-cache", credentials: "same-origin" }),
  address: (url) => url,
};
