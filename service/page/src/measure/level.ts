// How far a phone is tilted, from its orientation; nothing where the browser does not tell.
import { useEffect, useState } from "preact/hooks";
import { messages } from "../messages";

export interface Tilt {
  /** Degrees by which the picture's top leans to the right. */
  readonly roll: number;
  /** Degrees by which the back of the phone looks down. */
  readonly pitch: number;
}

/** Closer is level: less does not show in measurements. */
const LEVEL_ROLL_DEG = 2;
const LEVEL_PITCH_DEG = 4;

/**
 * Tilt by the angles of a DeviceOrientationEvent and the angle of its screen, in degrees.
 *
 * The third row of R = Rz(alpha) Rx(beta) Ry(gamma) is where up is, in the phone's axes: x to the right of its screen
 * when it is held in its natural orientation, y to the top, z out of it. By Screen Orientation the angle is 90 when the
 * phone is turned counterclockwise and what it shows clockwise, so the top of what is shown lies at (sin, cos) of it.
 */
export function tiltOf(beta: number, gamma: number, screenAngle: number): Tilt {
  const [b, g, s] = [beta, gamma, screenAngle].map((angle) => (angle * Math.PI) / 180) as [number, number, number];
  const [x, y, z] = [-Math.cos(b) * Math.sin(g), Math.sin(b), Math.cos(b) * Math.cos(g)];
  const right = x * Math.cos(s) - y * Math.sin(s);
  const up = x * Math.sin(s) + y * Math.cos(s);
  const degrees = 180 / Math.PI;
  return { roll: -Math.atan2(right, up) * degrees, pitch: Math.asin(Math.max(-1, Math.min(1, z))) * degrees };
}

/** What to do so that the phone is level; null when it is. */
export function levelWord({ roll, pitch }: Tilt, facesUser: boolean): string | null {
  const { level } = messages.measure;
  if (Math.abs(roll) > LEVEL_ROLL_DEG) return roll > 0 ? level.left : level.right;
  if (Math.abs(pitch) <= LEVEL_PITCH_DEG) return null;
  return pitch > 0 === facesUser ? level.down : level.up;
}

type Asking = { requestPermission?: () => Promise<string> };

/** Some phones tell only who asks, by a tap. */
export async function askForLevel(): Promise<void> {
  const events = globalThis.DeviceOrientationEvent as Asking | undefined;
  await events?.requestPermission?.().catch(() => undefined);
}

/** How the phone is held; null where that is not known. */
export function useTilt(): Tilt | null {
  const [tilt, setTilt] = useState<Tilt | null>(null);
  useEffect(() => {
    const hear = ({ beta, gamma }: DeviceOrientationEvent) => {
      if (beta !== null && gamma !== null) setTilt(tiltOf(beta, gamma, screen.orientation?.angle ?? 0));
    };
    addEventListener("deviceorientation", hear);
    return () => removeEventListener("deviceorientation", hear);
  }, []);
  return tilt;
}
