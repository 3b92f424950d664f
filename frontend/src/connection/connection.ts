import { PROTOCOL_VERSION, type PageMessage, type ServerMessage } from "../protocol";
import { Signal } from "../signal";
import { openBrowserStorage } from "../storage";
import { unpackData, type DisplayData } from "./data";
import { isPiece, FrameAssembler } from "./frame-assembler";
import { askForProof } from "./proof";
import { readRecordingName } from "./recording-address";
import { unpackSamples, type SeriesSamples } from "./samples";
import type { Tokens } from "./tokens";
import { unpackTransforms, type Transforms } from "./transforms";

/**
 * The state of the connection. `ended`: the program has shut down; one with the same token may start again. `refused`:
 * the page has no token, or the program does not know its token. `outdated`: the page has a different version from the
 * server, and a reload did not help.
 */
export type ConnectionState = "connecting" | "connected" | "reconnecting" | "ended" | "refused" | "outdated";

const FIRST_RETRY_MS = 250;
/** Shorter than the time that a restarted server waits for the pages that were open before. */
const MAX_RETRY_MS = 2000;
const GOING_AWAY_CODE = 1001;
const UNAUTHORIZED_STATUS = 401;
/**
 * Messages of at least this length, in bytes or characters, are acknowledged. The server relies on acknowledgments of
 * longer ones only.
 */
const MIN_ACKNOWLEDGED_LENGTH = 1024;
const RELOADED_KEY = "linkwright.reloaded-for-protocol";

/** The WebSocket to the server, which is reopened after growing pauses when it is lost. */
export class Connection {
  readonly message = new Signal<ServerMessage>();
  readonly transforms = new Signal<Transforms>();
  readonly data = new Signal<DisplayData>();
  readonly samples = new Signal<SeriesSamples[]>();
  readonly stateChanged = new Signal<ConnectionState>();
  private readonly frameAssembler = new FrameAssembler();
  private socket: WebSocket | null = null;
  private retryMs = FIRST_RETRY_MS;
  private receivedCount = 0;
  private sentToken: string | null = null;
  /** The token that the server accepted from this page. */
  private acceptedToken: string | null = null;
  private attemptCount = 0;
  private retryTimer: ReturnType<typeof setTimeout> | undefined;
  private currentState: ConnectionState = "connecting";

  /**
   * `url` is the address of the server's WebSocket, without the token; `tokens` is null where the server asks for none.
   */
  constructor(
    private readonly url: string,
    readonly tokens: Tokens | null = null,
  ) {}

  /** Calls `listener` with every message of a type, until the returned function is called. */
  on<T extends ServerMessage["type"]>(
    type: T,
    listener: (message: Extract<ServerMessage, { type: T }>) => void,
  ): () => void {
    return this.message.on((message) => {
      if (message.type === type) listener(message as Extract<ServerMessage, { type: T }>);
    });
  }

  /** The number of messages received since the socket was opened. */
  get received(): number {
    return this.receivedCount;
  }

  get state(): ConnectionState {
    return this.currentState;
  }

  open(): void {
    clearTimeout(this.retryTimer);
    this.sentToken = this.tokens?.current ?? null;
    if (this.tokens && this.sentToken === null) {
      // The server may accept another page of this browser, whose token this page then uses.
      this.setState("refused");
      this.retryLater();
      return;
    }
    this.attemptCount += 1;
    if (this.sentToken !== null && this.acceptedToken !== null) void this.reconnect(this.sentToken, this.attemptCount);
    else this.connect();
  }

  /** Retries immediately instead of waiting for the timer. */
  retryNow(): void {
    if (this.socket === null && this.attemptCount > 0 && this.currentState !== "connected" && this.currentState !== "outdated") this.open();
  }

  /**
   * Sends the token only to a program that proves it knows the token already; another program may listen at the address
   * now.
   */
  private async reconnect(token: string, attempt: number): Promise<void> {
    const proof = await askForProof(this.url, token);
    if (attempt !== this.attemptCount) return;
    if (proof === "known") {
      this.connect();
      return;
    }
    if (proof === "unknown" && this.tokens?.refuse() !== true) this.setState("refused");
    this.retryLater();
  }

  private connect(): void {
    const socket = new WebSocket(this.address.href);
    socket.binaryType = "arraybuffer";
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => this.receive(event.data);
    socket.onclose = (event) => this.onClosed(event.code);
    this.socket = socket;
    this.receivedCount = 0;
  }

  /** Connects with another token immediately. */
  connectWith(token: string): void {
    this.tokens?.use(token);
    this.acceptedToken = null;
    this.setState("connecting");
    this.open();
  }

  /** Sends a message, or drops it while disconnected: actions of the user must not be replayed later. */
  send(message: PageMessage): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }

  /** Sends a binary frame, or drops it while disconnected. */
  sendBytes(frame: ArrayBuffer): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(frame);
  }

  private receive(data: string | ArrayBuffer): void {
    this.receivedCount += 1;
    const length = typeof data === "string" ? data.length : data.byteLength;
    // Acknowledge before the work: the server measures the throughput of the connection with it.
    if (this.receivedCount === 1 || length >= MIN_ACKNOWLEDGED_LENGTH) this.send({ type: "received", count: this.receivedCount });
    if (data instanceof ArrayBuffer) {
      this.receiveBytes(data);
      return;
    }
    const message = JSON.parse(data) as ServerMessage;
    if (message.type === "hello") {
      if (message.protocol !== PROTOCOL_VERSION) {
        this.reloadOutdated();
        return;
      }
      openBrowserStorage("sessionStorage").removeItem(RELOADED_KEY);
      this.acceptedToken = this.sentToken;
      if (this.sentToken !== null) this.tokens?.accept(this.sentToken);
      this.retryMs = FIRST_RETRY_MS;
      this.setState("connected");
    }
    this.message.emit(message);
  }

  protected receiveBytes(bytes: ArrayBuffer): void {
    if (isPiece(bytes)) {
      const frame = this.frameAssembler.add(bytes);
      if (frame) this.receiveBytes(frame);
      return;
    }
    const transforms = unpackTransforms(bytes);
    if (transforms) this.transforms.emit(transforms);
    const content = unpackData(bytes);
    if (content) this.data.emit(content);
    const samples = unpackSamples(bytes);
    if (samples) this.samples.emit(samples);
  }

  private onClosed(code: number): void {
    this.socket = null;
    if (this.currentState === "outdated") return;
    if (code === GOING_AWAY_CODE) this.setState("ended");
    else if (this.currentState === "connected") this.setState("reconnecting");
    else if (this.receivedCount === 0) void this.findRefusal();
    this.retryLater();
  }

  private retryLater(): void {
    this.retryTimer = setTimeout(() => this.open(), this.retryMs);
    this.retryMs = Math.min(this.retryMs * 1.6, MAX_RETRY_MS);
  }

  /** The address of the socket, with the token. */
  private get address(): URL {
    const url = new URL(this.url);
    if (this.sentToken !== null) url.searchParams.set("token", this.sentToken);
    return url;
  }

  /** Finds out why the socket did not open: its close event gives no reason, but an ordinary request does. */
  private async findRefusal(): Promise<void> {
    const url = this.address;
    url.protocol = url.protocol === "wss:" ? "https:" : "http:";
    try {
      const { status } = await fetch(url, { cache: "no-store" });
      if (status !== UNAUTHORIZED_STATUS || this.socket?.readyState === WebSocket.OPEN) return;
      if (this.tokens?.refuse() !== true) this.setState("refused");
    } catch {
      // No server answers.
    }
  }

  /** Reloads the page once: the server now has another version, and serves the page that belongs to it. */
  private reloadOutdated(): void {
    const socket = this.socket;
    this.setState("outdated");
    socket?.close();
    const tabStorage = openBrowserStorage("sessionStorage");
    if (tabStorage.getItem(RELOADED_KEY) !== null) return;
    tabStorage.setItem(RELOADED_KEY, "yes");
    location.reload();
  }

  protected setState(state: ConnectionState): void {
    if (state === this.currentState) return;
    this.currentState = state;
    this.stateChanged.emit(state);
  }
}

/**
 * Returns the address of the WebSocket for a page at `page`. `ownKey` is the key of the page's own displays, `language`
 * the language of the server's texts.
 */
export function createSocketUrl(page: string, ownKey: string | null = null, language: string | null = null): string {
  const url = new URL("ws", page);
  url.protocol = url.protocol === "https:" ? "wss:" : "ws:";
  if (ownKey !== null) url.searchParams.set("own", ownKey);
  if (language !== null) url.searchParams.set("language", language);
  const recording = readRecordingName(page);
  if (recording !== null) url.searchParams.set("recording", recording);
  return url.href;
}
