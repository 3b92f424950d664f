/** Saves a text as a file on the user's machine. */
export function saveText(name: string, text: string, type: string): void {
  saveBlob(name, new Blob([text], { type }));
}

/** Saves an image or a video as a file on the user's machine. */
export function saveBlob(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  saveFromUrl(name, url);
  URL.revokeObjectURL(url);
}

/** Downloads a file of the server and saves it on the user's machine. */
export function saveFromUrl(name: string, url: string): void {
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
}
