import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { VideoRecorder } from "../src/scene/video";

class FakeRecorder {
  static isTypeSupported = (type: string): boolean => type === "video/webm";
  ondataavailable: (event: { data: Blob }) => void = () => undefined;
  onstop: () => void = () => undefined;
  readonly mimeType = "video/webm";
  start(): void {
    this.ondataavailable({ data: new Blob(["frames"]) });
  }
  stop(): void {
    this.onstop();
  }
}

const canvas = { captureStream: () => ({ getTracks: () => [] }) } as unknown as HTMLCanvasElement;

describe("a video", () => {
  beforeEach(() => {
    vi.useFakeTimers();
    vi.stubGlobal("window", { setInterval });
    vi.stubGlobal("MediaRecorder", FakeRecorder);
  });
  afterEach(() => {
    vi.useRealTimers();
    vi.unstubAllGlobals();
  });

  it("has frames of a still scene, which is drawn ten times per second while it is recorded", async () => {
    let drawCount = 0;
    const videos: Blob[] = [];
    const recorder = new VideoRecorder(canvas, () => drawCount++, (video) => videos.push(video));
    await vi.advanceTimersByTimeAsync(1000);
    expect(drawCount).toBe(0);
    recorder.start();
    await vi.advanceTimersByTimeAsync(2000);
    expect(drawCount).toBe(21);
    recorder.stop();
    await vi.advanceTimersByTimeAsync(2000);
    expect(drawCount).toBe(21);
    expect(videos).toHaveLength(1);
  });
});
