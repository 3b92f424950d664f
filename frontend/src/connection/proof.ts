/** Whether a server knows a token, without sending it: "silent" if no server answers. */
export type Proof = "known" | "unknown" | "silent";

/**
 * Asks the server of a socket's address to prove that it knows a token. After a program has ended, the next program
 * at its port would otherwise receive the token, and could open the page of a later one.
 *
 * Browsers compute for pages of this machine, or by HTTPS, only. Elsewhere the server is believed: there no program keeps
 * its token.
 */
export async function askForProof(socketUrl: string, token: string): Promise<Proof> {
  const { subtle } = globalThis.crypto as Partial<Crypto>;
  if (!subtle) return "known";
  const nonce = hex(crypto.getRandomValues(new Uint8Array(16)));
  const url = new URL("proof", socketUrl);
  url.protocol = url.protocol === "wss:" ? "https:" : "http:";
  url.searchParams.set("nonce", nonce);
  const text = new TextEncoder();
  const key = await subtle.importKey("raw", text.encode(token), { name: "HMAC", hash: "SHA-256" }, false, ["sign"]);
  const expected = hex(new Uint8Array(await subtle.sign("HMAC", key, text.encode(nonce))));
  try {
    const answer = await fetch(url, { cache: "no-store" });
    return (await answer.text()) === expected ? "known" : "unknown";
  } catch {
    return "silent";
  }
}

function hex(bytes: Uint8Array): string {
  return Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");
}
