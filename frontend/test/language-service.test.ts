import { afterEach, beforeEach, expect, it, vi } from "vitest";
import type { Connection } from "../src/connection/connection";
import type { Documents } from "../src/panels/source-editor/documents";
import { LanguageService } from "../src/panels/source-editor/language-service";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

beforeEach(() => {
  vi.useFakeTimers();
});
afterEach(() => {
  vi.useRealTimers();
});

interface SentMessage {
  readonly id?: number;
  readonly method: string;
}

function startService() {
  const sentMessages: SentMessage[] = [];
  let receive: (message: { content: string }) => void = () => undefined;
  const connection = {
    send: ({ content }: { content: string }) => sentMessages.push(JSON.parse(content) as SentMessage),
    on: (_: string, listener: typeof receive) => (receive = listener),
  };
  const { client } = connect(connection as unknown as Connection);
  return {
    client,
    methods: () => sentMessages.map(({ method }) => method),
    answer: (method: string, result: unknown) => {
      const id = sentMessages.find((candidate) => candidate.method === method)?.id;
      receive({ content: JSON.stringify({ jsonrpc: "2.0", id, result }) });
    },
  };
}

function connect(connection: Connection): LanguageService {
  const service = new LanguageService(connection, { open: [] } as unknown as Documents);
  service.connect("file:///ws");
  return service;
}

it("requests wait for a server that starts slowly", async () => {
  const { client, methods, answer } = startService();
  const symbols = client.request<object, string[]>("workspace/symbol", {});
  await vi.advanceTimersByTimeAsync(120_000);
  expect(methods()).toEqual(["initialize"]);
  answer("initialize", { capabilities: {} });
  await vi.advanceTimersByTimeAsync(10_000);
  answer("workspace/symbol", ["a"]);
  expect(await symbols).toEqual(["a"]);
});

it("a request without an answer ends, with none if the next key repeats it", async () => {
  const { client, answer } = startService();
  answer("initialize", { capabilities: {} });
  const hover = client.request("textDocument/hover", {});
  const symbols = client.request("workspace/symbol", {}).catch((error: unknown) => String(error));
  await vi.advanceTimersByTimeAsync(21_000);
  expect(await hover).toBeNull();
  expect(await symbols).toBe("Error: Request timed out");
});
