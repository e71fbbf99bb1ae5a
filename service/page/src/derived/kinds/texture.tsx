// Textures: of the picture, or of one's own.
import type { TextureColours, TextureSize } from "../../api/types";
import { LIMITS } from "../../api/limits";
import { Choice } from "../../ui/Choice";
import { FileChoice } from "../FileChoice";
import { percent } from "../percent";
import type { Kind, OptionProps } from "./kind";

interface TextureWishes {
  readonly colours: TextureColours;
  readonly size: TextureSize;
  /** A texture of one's own, in the atlas' layout. */
  readonly texture: File | null;
}

export const FIRST_TEXTURE: TextureWishes = { colours: "picture", size: 1024, texture: null };

export const texture: Kind<TextureWishes> = {
  label: "Texture",
  help: "The picture, or a texture of your own, laid on the body. What the picture does not show is made up.",
  request: ({ colours, size }) => ({ kind: "texture", colours, ...(colours === "own" ? {} : { size }) }),
  part: ({ colours, texture }) => (colours === "own" && texture ? { name: "texture", file: texture } : null),
  lacks: ({ colours, texture }) => (colours === "own" && !texture ? "Choose a texture first." : null),
  Options: TextureChoice,
  turns: { file: "body_textured.glb", label: "The textured body" },
  pictures: [
    { file: "texture.png", alt: "Texture of the body" },
    {
      file: "coverage.png",
      alt: "Where the texture comes from",
      caption: "Where it comes from: white was seen in the picture, grey is mirrored from the other side of the body, black is continued from its surroundings.",
    },
  ],
  told: (result) => {
    if (result.kind !== "texture") return null;
    const { seen_share: seen, mirrored_share: mirrored } = result;
    return (
      <p class="fine">
        {`${percent(seen)} of the body was seen, ${percent(mirrored)} is mirrored, ${percent(1 - seen - mirrored)} continued.`}
      </p>
    );
  },
};

const PHOTOGRAPHED = { value: "picture", label: "As photographed", title: "With the light of the picture" } as const;
const UNLIT = { value: "albedo", label: "Without the light", title: "The albedo: to be lit anew" } as const;
const OWN = { value: "own", label: "My own", title: "A texture painted in the atlas’ layout" } as const;

function TextureChoice({ hasLight, wishes, onWish }: OptionProps<TextureWishes>) {
  return (
    <>
      <Choice<TextureColours>
        name="colours"
        legend="Colours"
        options={hasLight ? [PHOTOGRAPHED, UNLIT, OWN] : [PHOTOGRAPHED, OWN]}
        value={wishes.colours}
        onChange={(colours) => onWish({ colours })}
      />
      {!hasLight && <p class="fine">Only a fit with shading can take the light out of the picture.</p>}
      {wishes.colours === "own" ? <OwnTexture wishes={wishes} onWish={onWish} /> : <TextureSide wishes={wishes} onWish={onWish} />}
    </>
  );
}

type Wished = Pick<OptionProps<TextureWishes>, "wishes" | "onWish">;

function OwnTexture({ wishes: { texture }, onWish }: Wished) {
  return (
    <div class="row">
      <FileChoice
        label={texture ? "Another texture" : "Choose a texture"}
        accept="image/png,image/jpeg,image/webp"
        onChoose={(file) => onWish({ texture: file })}
      />
      <span class="fine grow">
        {texture
          ? `${texture.name} is laid on the body.`
          : "A square picture. Make a texture first: its atlas.png says where each part of the body lies."}
      </span>
    </div>
  );
}

function TextureSide({ wishes, onWish }: Wished) {
  return (
    <div class="field">
      <label for="texture-size">Size</label>
      <select
        id="texture-size"
        value={wishes.size}
        onChange={(event) => onWish({ size: Number(event.currentTarget.value) as TextureSize })}
      >
        {LIMITS.textureSizes.map((size) => (
          <option key={size} value={size}>
            {size} × {size}
          </option>
        ))}
      </select>
    </div>
  );
}
