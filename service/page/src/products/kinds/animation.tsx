// The body in motion.
import type { NamedMotion } from "../../api/types";
import { messages } from "../../messages";
import { Choice } from "../../ui/Choice";
import { FileButton } from "../../ui/FileButton";
import type { Kind, OptionProps } from "./kind";

interface AnimationWishes {
  readonly named: NamedMotion;
  /** A BVH file, which goes before the name. */
  readonly motion: File | null;
}

const words = messages.products.animation;
const MOTIONS: readonly NamedMotion[] = ["walk", "a_pose", "t_pose"];

export const FIRST_ANIMATION: AnimationWishes = { named: "walk", motion: null };

export const animation: Kind<AnimationWishes> = {
  request: ({ named, motion }) => (motion ? { kind: "animation" } : { kind: "animation", motion: named }),
  part: ({ motion }) => motion && { name: "bvh", file: motion },
  Options: MotionOptions,
  body: { file: "body_animated.glb", still: "body_skinned.glb", label: words.turned },
};

function MotionOptions({ wishes: { named, motion }, onWish }: OptionProps<AnimationWishes>) {
  return (
    <>
      <Choice
        name="motion"
        legend={words.motion}
        quiet
        options={MOTIONS.map((value) => ({ value, label: words.motions[value] }))}
        value={motion ? null : named}
        onChange={(named) => onWish({ named, motion: null })}
      />
      <div class="row">
        <FileButton accept=".bvh" onChoose={([file]) => onWish({ motion: file! })}>
          {motion ? words.another : words.choose}
        </FileButton>
        <span class="fine grow">{motion ? words.moves(motion.name) : words.files}</span>
      </div>
    </>
  );
}
