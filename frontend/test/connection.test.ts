import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection, createSocketUrl } from "../src/connection/connection";
import { extractToken, Tokens, type AddressBar } from "../src/connection/tokens";
import { PROTOCOL_VERSION } from "../src/protocol";
import type { BrowserStorage } from "../src/storage";
import { packTransforms } from "./messages";

class FakeSocket {
  static readonly OPEN = 1;
  static instances: FakeSocket[] = [];
  readyState = 1;
  sentTexts: string[] = [];
  onmessage: ((event: { data: string | ArrayBuffer }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;

  constructor(readonly url: string) {
    FakeSocket.instances.push(this);
  }
  send(text: string): void {
    this.sentTexts.push(text);
  }
  close(): void {
    this.onclose?.({ code: 1000 });
  }
  receiveHello(protocol = PROTOCOL_VERSION): void {
    this.onmessage?.({ data: JSON.stringify({ type: "hello", protocol, version: "1", title: "", run: "1" }) });
  }
}

const reload = vi.fn();
const storage = new Map<string, string>();

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.instances = [];
  reload.mockClear();
  storage.clear();
  vi.stubGlobal("WebSocket", FakeSocket);
  vi.stubGlobal("location", { reload });
  vi.stubGlobal("sessionStorage", {
    getItem: (key: string) => storage.get(key) ?? null,
    setItem: (key: string, value: string) => storage.set(key, value),
    removeItem: (key: string) => storage.delete(key),
  });
});
afterEach(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});

function openConnection(): { connection: Connection; socket: FakeSocket } {
  const connection = new Connection("ws://127.0.0.1/ws");
  connection.open();
  return { connection, socket: FakeSocket.instances[0]! };
}

function createPage(href: string, storedToken?: string, isPersistent = true): { tokens: Tokens; storage: BrowserStorage; address: AddressBar } {
  const address = {
    href,
    moveTo(next: string) {
      address.href = next;
    },
  };
  const texts = new Map(storedToken === undefined ? [] : [["linkwright.token", storedToken]]);
  const storage = {
    isPersistent,
    getItem: (key: string) => texts.get(key) ?? null,
    setItem: (key: string, text: string) => void texts.set(key, text),
    removeItem: (key: string) => void texts.delete(key),
  };
  return { tokens: new Tokens(address, storage), storage, address };
}

describe("the token", () => {
  it("moves from the address to the browser's storage only after the server has accepted it", () => {
    const { tokens, storage, address } = createPage("http://localhost:7447/?token=abc&displays=own#x");
    expect(tokens.current).toBe("abc");
    expect(storage.getItem("linkwright.token")).toBeNull();
    tokens.accept("abc");
    expect(address.href).toBe("http://localhost:7447/?displays=own#x");
    expect(new Tokens(address, storage).current).toBe("abc");
    expect(tokens.link).toBe("http://localhost:7447/?displays=own&token=abc#x");
  });

  it("stays in the address if the browser stores nothing", () => {
    const { tokens, address } = createPage("http://localhost:7447/?token=abc", undefined, false);
    tokens.accept("abc");
    expect(address.href).toBe("http://localhost:7447/?token=abc");
  });

  it("in the address has priority, and an outdated one in the address does not delete the stored one", () => {
    const { tokens, storage } = createPage("http://localhost:7447/?token=old", "good");
    expect(tokens.current).toBe("old");
    expect(tokens.refuse()).toBe(true);
    expect(tokens.current).toBe("good");
    tokens.accept("good");
    expect(tokens.current).toBe("good");
    expect(storage.getItem("linkwright.token")).toBe("good");
    expect(tokens.refuse()).toBe(false);
  });

  it("is extracted from an address, or is the text itself", () => {
    expect(extractToken(" http://127.0.0.1:7447/?token=a-b_c\n")).toBe("a-b_c");
    expect(extractToken("Viewer: http://127.0.0.1:7447/?token=abc")).toBe("abc");
    expect(extractToken("0123456789abcdef_-AB")).toBe("0123456789abcdef_-AB");
    expect(extractToken("http://127.0.0.1:7447/")).toBeNull();
    expect(extractToken("hello")).toBeNull();
    expect(extractToken("")).toBeNull();
  });
});

describe("the connection", () => {
  it("is connected after the handshake and passes on both kinds of messages", () => {
    const { connection, socket } = openConnection();
    const [onMessage, onTransforms] = [vi.fn(), vi.fn()];
    connection.message.on(onMessage);
    connection.transforms.on(onTransforms);
    expect(connection.state).toBe("connecting");
    socket.receiveHello();
    socket.onmessage?.({ data: packTransforms(1, [[0, 0, 0, 0, 0, 0, 1]], [0]) });
    expect(connection.state).toBe("connected");
    expect(onMessage).toHaveBeenCalledOnce();
    expect(onTransforms).toHaveBeenCalledOnce();
  });

  it("acknowledges the handshake and large messages", () => {
    const { socket } = openConnection();
    socket.receiveHello();
    socket.onmessage?.({ data: packTransforms(1, [[0, 0, 0, 0, 0, 0, 1]], [0]) });
    socket.onmessage?.({ data: JSON.stringify({ type: "hello", protocol: PROTOCOL_VERSION, version: "1", title: "x".repeat(2000), run: "1" }) });
    const counts = socket.sentTexts.map((text) => JSON.parse(text) as unknown);
    expect(counts).toEqual([{ type: "received", count: 1 }, { type: "received", count: 3 }]);
  });

  it("reconnects with growing delays", () => {
    const { connection, socket } = openConnection();
    socket.receiveHello();
    socket.onclose?.({ code: 1006 });
    expect(connection.state).toBe("reconnecting");
    vi.advanceTimersByTime(250);
    expect(FakeSocket.instances).toHaveLength(2);
    FakeSocket.instances[1]!.onclose?.({ code: 1006 });
    vi.advanceTimersByTime(250);
    expect(FakeSocket.instances).toHaveLength(2);
    vi.advanceTimersByTime(200);
    expect(FakeSocket.instances).toHaveLength(3);
    FakeSocket.instances[2]!.receiveHello();
    expect(connection.state).toBe("connected");
  });

  it("distinguishes a server that has ended from a broken connection", () => {
    const { connection, socket } = openConnection();
    socket.receiveHello();
    socket.onclose?.({ code: 1001 });
    expect(connection.state).toBe("ended");
  });

  it("reports a program that does not know the page's token", async () => {
    const fetchPage = vi.fn<(createPage: URL) => Promise<{ status: number }>>(() => Promise.resolve({ status: 401 }));
    vi.stubGlobal("fetch", fetchPage);
    const { connection, socket } = openConnection();
    socket.receiveHello();
    socket.onclose?.({ code: 1001 });
    await vi.advanceTimersByTimeAsync(250);
    Object.assign(FakeSocket.instances[1]!, { readyState: 3 }).onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(0);
    expect(fetchPage.mock.calls[0]?.[0].href).toBe("http://127.0.0.1/ws");
    expect(connection.state).toBe("refused");
  });

  it("tries all known tokens before it reports a refusal, and keeps trying", async () => {
    vi.stubGlobal("fetch", () => Promise.resolve({ status: 401 }));
    const { tokens, storage } = createPage("http://127.0.0.1/?token=new", "old");
    const connection = new Connection("ws://127.0.0.1/ws", tokens);
    const refuse = async (): Promise<void> => {
      Object.assign(FakeSocket.instances.at(-1)!, { readyState: 3 }).onclose?.({ code: 1006 });
      await vi.advanceTimersByTimeAsync(0);
    };
    connection.open();
    await refuse();
    expect(connection.state).toBe("connecting");
    await vi.advanceTimersByTimeAsync(250);
    await refuse();
    expect(connection.state).toBe("refused");
    storage.setItem("linkwright.token", "of-another-tab");
    for (let time = 0; time < 3; time += 1) {
      await vi.advanceTimersByTimeAsync(4000);
      await refuse();
    }
    const sentTokens = FakeSocket.instances.map(({ url }) => new URL(url).searchParams.get("token"));
    expect(sentTokens.slice(0, 2)).toEqual(["new", "old"]);
    expect(sentTokens).toContain("of-another-tab");
  });

  it("does not connect without a token until another page of the browser has one", () => {
    const { tokens, storage } = createPage("http://127.0.0.1/");
    const connection = new Connection("ws://127.0.0.1/ws", tokens);
    connection.open();
    expect(connection.state).toBe("refused");
    expect(FakeSocket.instances).toEqual([]);
    storage.setItem("linkwright.token", "abc");
    vi.advanceTimersByTime(250);
    expect(FakeSocket.instances[0]?.url).toBe("ws://127.0.0.1/ws?token=abc");
    FakeSocket.instances[0]!.receiveHello();
    expect(connection.state).toBe("connected");
  });

  describe("after the program has ended", () => {
    const token = "a".repeat(32);

    /** A page that was connected and lost its server; returns what it asks the server that answers with `answer`. */
    async function returnToPage(answer: (nonce: string) => Promise<string>) {
      const requestedUrls: string[] = [];
      vi.stubGlobal("fetch", async (url: URL) => {
        requestedUrls.push(url.href);
        const text = await answer(url.searchParams.get("nonce") ?? "");
        return { status: 200, text: () => Promise.resolve(text) };
      });
      const { tokens } = createPage(`http://127.0.0.1/?token=${token}`);
      const connection = new Connection("ws://127.0.0.1/ws", tokens);
      connection.open();
      FakeSocket.instances[0]!.receiveHello();
      FakeSocket.instances[0]!.onclose?.({ code: 1001 });
      await vi.advanceTimersByTimeAsync(250);
      await vi.waitFor(() => expect(requestedUrls).not.toEqual([]));
      return { connection, asked: requestedUrls };
    }

    async function proofOf(nonce: string): Promise<string> {
      const [text, { subtle }] = [new TextEncoder(), crypto];
      const key = await subtle.importKey("raw", text.encode(token), { name: "HMAC", hash: "SHA-256" }, false, ["sign"]);
      const instances = new Uint8Array(await subtle.sign("HMAC", key, text.encode(nonce)));
      return Array.from(instances, (byte) => byte.toString(16).padStart(2, "0")).join("");
    }

    /** Replaces the browser's digest, which runs in threads: the test's clock does not wait for these, and they would end in the next test. */
    function stubCrypto(): void {
      const subtle = {
        importKey: (_format: string, key: Uint8Array) => Promise.resolve(key),
        sign: (_name: string, key: Uint8Array, text: Uint8Array) => Promise.resolve(text.map((byte, index) => byte ^ key[index]!).buffer),
      };
      const { crypto } = globalThis;
      vi.stubGlobal("crypto", { subtle, getRandomValues: (bytes: Uint8Array<ArrayBuffer>) => crypto.getRandomValues(bytes) });
    }

    it("reconnects to a program that proves that it knows the token", async () => {
      const { connection, asked } = await returnToPage(proofOf);
      await vi.waitFor(() => expect(FakeSocket.instances).toHaveLength(2));
      FakeSocket.instances[1]!.receiveHello();
      expect(connection.state).toBe("connected");
      expect(asked[0]).toMatch(/^http:\/\/127\.0\.0\.1\/proof\?nonce=[0-9a-f]{32}$/);
    });

    it("never sends the token to another program, and reports that it is another", async () => {
      stubCrypto();
      const answers = ["", "<html>", "0".repeat(64), await proofOf("0".repeat(32))];
      for (const answer of answers) {
        FakeSocket.instances = [];
        const { connection, asked } = await returnToPage(() => Promise.resolve(answer));
        await vi.waitFor(() => expect(connection.state).toBe("refused"));
        expect(FakeSocket.instances).toHaveLength(1);
        expect(asked.join()).not.toContain(token);
      }
    });

    it("asks again with a new number while there is no answer, and at once when the page becomes visible", async () => {
      stubCrypto();
      const { connection, asked } = await returnToPage(() => Promise.reject(new Error("nobody")));
      await vi.advanceTimersByTimeAsync(10_000);
      expect(asked.length).toBeGreaterThan(3);
      expect(connection.state).toBe("ended");
      expect(new Set(asked).size).toBe(asked.length);
      const countBefore = asked.length;
      connection.retryNow();
      await vi.advanceTimersByTimeAsync(0);
      expect(asked).toHaveLength(countBefore + 1);
    });
  });

  it("reloads the page once if the server has another protocol version", () => {
    const first = openConnection();
    first.socket.receiveHello(PROTOCOL_VERSION + 1);
    expect(reload).toHaveBeenCalledOnce();
    FakeSocket.instances = [];
    const second = openConnection();
    second.socket.receiveHello(PROTOCOL_VERSION + 1);
    expect(reload).toHaveBeenCalledOnce();
    expect(second.connection.state).toBe("outdated");
  });
});

describe("the socket's address", () => {
  it("is relative to the page", () => {
    expect(createSocketUrl("http://127.0.0.1:7447/?token=abc")).toBe("ws://127.0.0.1:7447/ws");
    expect(createSocketUrl("https://lab.example/robots/mbot/")).toBe("wss://lab.example/robots/mbot/ws");
    expect(createSocketUrl("http://127.0.0.1:7447/", null, "zh")).toBe("ws://127.0.0.1:7447/ws?language=zh");
  });
});
