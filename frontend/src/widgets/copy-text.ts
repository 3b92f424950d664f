/**
 * Copies a text to the clipboard and returns whether that succeeded. Pages over plain HTTP from another machine lack
 * the clipboard API.
 */
export async function copyText(text: string): Promise<boolean> {
  const { clipboard } = navigator as { clipboard?: Clipboard };
  if (clipboard) {
    return clipboard.writeText(text).then(
      () => true,
      () => false,
    );
  }
  const textarea = document.createElement("textarea");
  textarea.value = text;
  textarea.style.position = "fixed";
  textarea.style.opacity = "0";
  document.body.append(textarea);
  textarea.select();
  // Only the deprecated function is available on such pages.
  // eslint-disable-next-line @typescript-eslint/no-deprecated
  const wasCopied = document.execCommand("copy");
  textarea.remove();
  return wasCopied;
}
