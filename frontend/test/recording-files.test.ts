import { describe, expect, it, vi } from "vitest";
import { createSocketUrl } from "../src/connection/connection";
import { setRecordingName, readRecordingName } from "../src/connection/recording-address";
import { findRecording } from "../src/shell/recording-files";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en, language: "en" }));

function createFiles(...names: string[]): { name: string; file: Blob }[] {
  return names.map((name) => ({ name, file: new Blob(["x"]) }));
}

describe("dropped files", () => {
  it("are recognized as a recording by their names", () => {
    const { name, files } = findRecording("drive", createFiles("notes.txt", "metadata.yaml", "drive_0.db3", "drive_1.db3.zstd", ".DS_Store"));
    expect(name).toBe("drive");
    expect(files.map((item) => item.name)).toEqual(["metadata.yaml", "drive_0.db3", "drive_1.db3.zstd"]);
  });

  it("are a single recording file if only one has messages", () => {
    const { name, files } = findRecording("drive", createFiles("metadata.yaml", "drive_0.mcap"));
    expect([name, files.length, files[0]?.name]).toEqual(["drive_0.mcap", 1, "drive_0.mcap"]);
  });

  it("are no recording if none has messages", () => {
    expect(findRecording("images", createFiles("a.png", "mcap")).files).toEqual([]);
    expect(findRecording("drive", createFiles("metadata.yaml")).files).toEqual([]);
    expect(findRecording("robot.urdf", createFiles("robot.urdf")).files).toEqual([]);
  });
});

describe("the page of a recording", () => {
  it("has a name in its address and that of its socket", () => {
    const address = setRecordingName("http://localhost:7448/?displays=own", "abc");
    expect(readRecordingName(address)).toBe("abc");
    expect(createSocketUrl(address)).toBe("ws://localhost:7448/ws?recording=abc");
    expect(setRecordingName(address, null)).toBe("http://localhost:7448/?displays=own");
  });
});
