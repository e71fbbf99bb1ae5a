// Tones of the countdown: somebody who stands two metres away does not read figures.
let context: AudioContext | null = null;

const SHORT_S = 0.12;
const LONG_S = 0.5;

/** To be called by a tap: some phones stay silent otherwise. */
export function allowSound(): void {
  try {
    context ??= new AudioContext();
    void context.resume();
  } catch {
    // Without sound there are the figures.
  }
}

/** A tone for every second, and a longer and higher one at the end. */
export function beep(last: boolean): void {
  try {
    context ??= new AudioContext();
    const tone = context.createOscillator();
    const volume = context.createGain();
    tone.frequency.value = last ? 1320 : 880;
    volume.gain.value = 0.25;
    tone.connect(volume).connect(context.destination);
    tone.start();
    tone.stop(context.currentTime + (last ? LONG_S : SHORT_S));
  } catch {
    // Without sound there are the figures.
  }
}
