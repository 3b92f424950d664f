/** Gives the user a text as a file. */
export function saveText(name: string, text: string, type: string): void {
  saveBlob(name, new Blob([text], { type }));
}

/** Gives the user an image or a video as a file. */
export function saveBlob(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  saveFrom(name, url);
  URL.revokeObjectURL(url);
}

/** Has the browser fetch a file of the server and save it. */
export function saveFrom(name: string, url: string): void {
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
}
