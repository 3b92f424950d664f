import { describe, expect, it, vi } from "vitest";
import { Connection } from "../src/connection/connection";
import type { ProgramPage, ServerMessage } from "../src/protocol";
import { takeRequested, addSettings } from "../src/requested-settings";
import { TerminalsState } from "../src/state/terminals";

const WORLD: ProgramPage = { id: 1, title: "world", url: "http://127.0.0.1:7449/?token=abc" };

function createState(): { state: TerminalsState; sentMessages: unknown[]; receive: (message: object) => void; news: boolean[] } {
  const connection = new Connection("ws://localhost/ws");
  const sentMessages: unknown[] = [];
  vi.spyOn(connection, "send").mockImplementation((message) => void sentMessages.push(message));
  const state = new TerminalsState(connection);
  const news: boolean[] = [];
  state.programsChanged.on((hasNew) => news.push(hasNew));
  return { state, sentMessages, receive: (message) => connection.message.emit(message as ServerMessage), news };
}

const createTerminals = (folder: string): object => ({ type: "terminals", folder, terminals: [], refusal_reason: "" });

describe("the pages of programs", () => {
  it("are requested once for each connection, where there are terminals", () => {
    const { sentMessages, receive } = createState();
    for (const message of [{ type: "hello" }, createTerminals("/ws"), createTerminals("/ws")]) receive(message);
    expect(sentMessages).toEqual([{ type: "watch_program_pages" }]);
    for (const message of [{ type: "hello" }, createTerminals("")]) receive(message);
    expect(sentMessages).toHaveLength(1);
  });

  it("are new, are kept and end", () => {
    const { state, receive, news } = createState();
    receive(createTerminals("/ws"));
    for (const pages of [[WORLD], [WORLD, { ...WORLD, id: 2 }], [WORLD], []]) receive({ type: "program_pages", pages });
    expect(news).toEqual([true, true, false, false]);
    receive({ type: "program_pages", pages: [WORLD] });
    receive({ type: "hello" });
    receive({ type: "frame_table" });
    expect(state.programs).toEqual([]);
  });
});

describe("the settings of a program's page", () => {
  it("are those of the page around it, and do not stay in its address", () => {
    const address = addSettings(WORLD.url, { language: "zh", theme: "dark" });
    expect(address).toBe("http://127.0.0.1:7449/?token=abc&language=zh&theme=dark");
    const location = { href: address };
    const history = { state: null, replaceState: (_: unknown, unused: string, url: URL) => (location.href = url.href + unused) };
    const takeSetting = (setting: "language" | "theme"): string | null => takeRequested(setting, location as Location, history as unknown as History);
    expect([takeSetting("language"), takeSetting("theme"), takeSetting("theme")]).toEqual(["zh", "dark", null]);
    expect(location.href).toBe(WORLD.url);
    expect(takeRequested("language", undefined, undefined)).toBeNull();
  });
});
