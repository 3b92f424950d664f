import type { Tokens } from "./tokens";

/** A file to upload, with its name on the server. */
export interface NamedFile {
  name: string;
  file: Blob;
}

/** The server refused the upload; the message is its reason. */
export class RefusedError extends Error {}

/** Uploads the files of a recording one after the other, or opens a recording that is already on the server. */
export class Upload {
  private request: XMLHttpRequest | null = null;
  private key = "";
  private isCancelled = false;

  /**
   * @param base - the address of the page.
   * @param language - the language of the server's error messages.
   * @param onProgress - receives the number of bytes sent.
   */
  constructor(
    private readonly base: string,
    private readonly tokens: Tokens,
    private readonly language: string,
    private readonly onProgress: (sentBytes: number) => void,
  ) {}

  /** Uploads a recording and returns the server's name for it; null if it was cancelled. */
  async send(name: string, files: readonly NamedFile[]): Promise<string | null> {
    const announcement = { name, files: files.map((namedFile) => ({ name: namedFile.name, size: namedFile.file.size })) };
    this.key = (await this.fetchResponse("POST", "recordings", JSON.stringify(announcement)))?.key ?? "";
    let finishedBytes = 0;
    for (const [number, { file }] of files.entries()) {
      await this.fetchResponse("PUT", `recordings/${this.key}/${number}`, file, (sentBytes) => this.onProgress(finishedBytes + sentBytes));
      finishedBytes += file.size;
    }
    this.onProgress(finishedBytes);
    return (await this.fetchResponse("POST", `recordings/${this.key}`, null))?.recording ?? null;
  }

  /** Opens a recording of the server by the address of its file, and returns its name; null if this was cancelled. */
  async openRecording(file: string): Promise<string | null> {
    return (await this.fetchResponse("POST", file, null))?.recording ?? null;
  }

  cancel(): void {
    this.isCancelled = true;
    this.request?.abort();
    if (this.key !== "") void fetch(this.createAddress(`recordings/${this.key}`), { method: "DELETE" }).catch(() => undefined);
  }

  /** Sends a request and returns the server's answer; null once this is cancelled. */
  private fetchResponse(method: string, path: string, body: Blob | string | null, onSent?: (bytes: number) => void): Promise<UploadResponse | null> {
    if (this.isCancelled) return Promise.resolve(null);
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      this.request = request;
      request.open(method, this.createAddress(path));
      if (onSent) request.upload.addEventListener("progress", ({ loaded }) => onSent(loaded));
      request.addEventListener("load", () => {
        const response = parseResponse(request.responseText);
        if (request.status < 300 && response.problem === undefined) resolve(response);
        else reject(new RefusedError(response.problem ?? request.responseText.trim()));
      });
      request.addEventListener("error", () => reject(new RefusedError("")));
      request.addEventListener("abort", () => resolve(null));
      request.send(body);
    });
  }

  private createAddress(path: string): string {
    const url = new URL(path, new URL(".", this.base));
    const { current } = this.tokens;
    url.searchParams.set("language", this.language);
    if (current !== null) url.searchParams.set("token", current);
    return url.href;
  }
}

interface UploadResponse {
  key?: string;
  recording?: string;
  problem?: string;
}

function parseResponse(text: string): UploadResponse {
  try {
    return JSON.parse(text) as UploadResponse;
  } catch {
    return {};
  }
}
