/** Whether a server knows a token: "silent" if no server answers. */
export type ServerIdentity = "known" | "unknown" | "silent";

/**
 * Asks the server of a socket's address to prove that it knows a token, without sending the token. Without this
 * check, another program that later listens on the port would receive the token, and could use it.
 *
 * Browsers offer cryptography only to pages of this machine or over HTTPS. Elsewhere the server is trusted without
 * proof: a program there does not reuse its token.
 */
export async function askForProof(socketUrl: string, token: string): Promise<ServerIdentity> {
  const { subtle } = globalThis.crypto as Partial<Crypto>;
  if (!subtle) return "known";
  const nonce = formatHex(crypto.getRandomValues(new Uint8Array(16)));
  const url = new URL("proof", socketUrl);
  url.protocol = url.protocol === "wss:" ? "https:" : "http:";
  url.searchParams.set("nonce", nonce);
  const encoder = new TextEncoder();
  const key = await subtle.importKey("raw", encoder.encode(token), { name: "HMAC", hash: "SHA-256" }, false, ["sign"]);
  const expectedProof = formatHex(new Uint8Array(await subtle.sign("HMAC", key, encoder.encode(nonce))));
  try {
    const response = await fetch(url, { cache: "no-store" });
    return (await response.text()) === expectedProof ? "known" : "unknown";
  } catch {
    return "silent";
  }
}

function formatHex(bytes: Uint8Array): string {
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}
