import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { Connection, socketUrl } from "../src/connection/connection";
import { PROTOCOL_VERSION } from "../src/protocol";
import { packed } from "./messages";

class FakeSocket {
  static readonly OPEN = 1;
  static made: FakeSocket[] = [];
  readyState = 1;
  sent: string[] = [];
  onmessage: ((event: { data: string | ArrayBuffer }) => void) | null = null;
  onclose: ((event: { code: number }) => void) | null = null;

  constructor(readonly url: string) {
    FakeSocket.made.push(this);
  }
  send(text: string): void {
    this.sent.push(text);
  }
  close(): void {
    this.onclose?.({ code: 1000 });
  }
  hello(protocol = PROTOCOL_VERSION): void {
    this.onmessage?.({ data: JSON.stringify({ type: "hello", protocol, version: "1", title: "" }) });
  }
}

const reload = vi.fn();
const storage = new Map<string, string>();

beforeEach(() => {
  vi.useFakeTimers();
  FakeSocket.made = [];
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

function opened(): { connection: Connection; socket: FakeSocket } {
  const connection = new Connection("ws://127.0.0.1/ws");
  connection.open();
  return { connection, socket: FakeSocket.made[0]! };
}

describe("the connection", () => {
  it("is connected after the greeting and hands on both kinds of messages", () => {
    const { connection, socket } = opened();
    const [message, transforms] = [vi.fn(), vi.fn()];
    connection.message.on(message);
    connection.transforms.on(transforms);
    expect(connection.state).toBe("connecting");
    socket.hello();
    socket.onmessage?.({ data: packed(1, [[0, 0, 0, 0, 0, 0, 1]], [0]) });
    expect(connection.state).toBe("connected");
    expect(message).toHaveBeenCalledOnce();
    expect(transforms).toHaveBeenCalledOnce();
  });

  it("acknowledges the greeting and whatever is large", () => {
    const { socket } = opened();
    socket.hello();
    socket.onmessage?.({ data: packed(1, [[0, 0, 0, 0, 0, 0, 1]], [0]) });
    socket.onmessage?.({ data: JSON.stringify({ type: "hello", protocol: PROTOCOL_VERSION, version: "1", title: "x".repeat(2000) }) });
    const counts = socket.sent.map((text) => JSON.parse(text) as unknown);
    expect(counts).toEqual([{ type: "received", count: 1 }, { type: "received", count: 3 }]);
  });

  it("comes back with growing pauses", () => {
    const { connection, socket } = opened();
    socket.hello();
    socket.onclose?.({ code: 1006 });
    expect(connection.state).toBe("reconnecting");
    vi.advanceTimersByTime(250);
    expect(FakeSocket.made).toHaveLength(2);
    FakeSocket.made[1]!.onclose?.({ code: 1006 });
    vi.advanceTimersByTime(250);
    expect(FakeSocket.made).toHaveLength(2);
    vi.advanceTimersByTime(200);
    expect(FakeSocket.made).toHaveLength(3);
    FakeSocket.made[2]!.hello();
    expect(connection.state).toBe("connected");
  });

  it("knows a server that ended from a line that broke", () => {
    const { connection, socket } = opened();
    socket.hello();
    socket.onclose?.({ code: 1001 });
    expect(connection.state).toBe("ended");
  });

  it("says so when a program is there that does not know the page", async () => {
    const asked = vi.fn<(page: URL) => Promise<{ status: number }>>(() => Promise.resolve({ status: 401 }));
    vi.stubGlobal("fetch", asked);
    const { connection, socket } = opened();
    socket.hello();
    socket.onclose?.({ code: 1001 });
    await vi.advanceTimersByTimeAsync(250);
    Object.assign(FakeSocket.made[1]!, { readyState: 3 }).onclose?.({ code: 1006 });
    await vi.advanceTimersByTimeAsync(0);
    expect(asked.mock.calls[0]?.[0].href).toBe("http://127.0.0.1/");
    expect(connection.state).toBe("refused");
  });

  it("reloads the page once when the server speaks another version", () => {
    const first = opened();
    first.socket.hello(PROTOCOL_VERSION + 1);
    expect(reload).toHaveBeenCalledOnce();
    FakeSocket.made = [];
    const second = opened();
    second.socket.hello(PROTOCOL_VERSION + 1);
    expect(reload).toHaveBeenCalledOnce();
    expect(second.connection.state).toBe("outdated");
  });
});

describe("the socket's address", () => {
  it("stands beside the page and takes its token along", () => {
    expect(socketUrl("http://127.0.0.1:7447/?token=abc")).toBe("ws://127.0.0.1:7447/ws?token=abc");
    expect(socketUrl("https://lab.example/robots/mbot/")).toBe("wss://lab.example/robots/mbot/ws");
  });
});
