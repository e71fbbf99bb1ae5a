import{b as g}from"/page/chunk.VLFINDIR.js";import{a as b,b as x,c as S,e as P,f as w,g as s,h as E,i as L,j as T,k as u,l as v,m as M,n as d,o as A,p as C,q as G,u as B,v as R,w as z}from"/page/chunk.2AMI6IUB.js";var F=["lit","clay","albedo","specularity","shading","residual","change"],D=`
  in vec3 tint;
  in float albedo;
  in float specularity;
  in vec3 posed;
  in vec3 posedNormal;
  in float lit;
  in float posedLit;
  in float shift;
  out float vLit;
  out float vPosedLit;
  out vec3 vPosition;
  out vec3 vNormal;
  out vec3 vTint;
  out vec2 vReflectance;
  out vec3 vPosed;
  out vec3 vPosedNormal;
  out float vShift;
  void main() {
    vPosition = position;
    vNormal = normal;
    vTint = tint;
    vReflectance = vec2(albedo, specularity);
    vPosed = posed;
    vPosedNormal = posedNormal;
    vLit = lit;
    vPosedLit = posedLit;
    vShift = shift;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,U=`
  precision highp float;
  in vec3 vPosition;
  in vec3 vNormal;
  in vec3 vTint;
  in vec2 vReflectance;
  in vec3 vPosed;
  in vec3 vPosedNormal;
  in float vShift;
  in float vLit;
  in float vPosedLit;
  uniform bool hasSurroundings;
  uniform float surroundings[9];
  uniform int surface;
  uniform bool isPoint;
  uniform vec3 lightVector;
  uniform vec3 posedLight;
  uniform float lightDistance;
  uniform float ambient;
  uniform float exponent;
  uniform vec3 eye;
  uniform vec3 clay;
  uniform sampler2D picture;
  uniform vec2 pictureSize;
  uniform vec3 intrinsics;
  out vec4 colour;

  vec2 eq1(vec3 position, vec3 normal, vec3 toEye, vec3 light) {
    vec3 path = isPoint ? light - position : light;
    float intensity = isPoint ? lightDistance * lightDistance / dot(path, path) : 1.0;
    vec3 toLight = normalize(path);
    float facing = dot(toLight, normal);
    if (facing <= 0.0) return vec2(0.0);
    float mirror = max(dot(normalize(toLight + toEye), normal), 0.0);
    return intensity * vec2(facing, pow(mirror, exponent));
  }

  float fromSurroundings(vec3 n) {
    float sum = 0.2820947918 * surroundings[0]
      + 0.4886025119 * dot(vec3(surroundings[3], surroundings[1], surroundings[2]), n)
      + 1.0925484306 * (surroundings[4] * n.x * n.y + surroundings[5] * n.y * n.z + surroundings[7] * n.x * n.z)
      + 0.3153915653 * surroundings[6] * (3.0 * n.z * n.z - 1.0)
      + 0.5462742153 * surroundings[8] * (n.x * n.x - n.y * n.y);
    return max(sum, 0.0);
  }

  // What a surface of this albedo and specularity shows, given the factors of Eq. 1.
  vec3 shaded(vec3 albedo, float specularity, vec3 normal, vec2 terms, float isLit) {
    if (!hasSurroundings) return ambient + albedo * terms.x + specularity * terms.y;
    return albedo * (fromSurroundings(normal) + isLit * terms.x) + specularity * isLit * terms.y;
  }

  vec3 encoded(vec3 linear) {
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
  }

  vec3 decoded(vec3 display) {
    return mix(pow((display + 0.055) / 1.055, vec3(2.4)), display / 12.92, lessThanEqual(display, vec3(0.04045)));
  }

  vec3 claySurface(vec3 normal, vec3 toEye) {
    float key = max(dot(normal, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float sky = 0.5 + 0.5 * normal.y;
    float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
    return clay * (0.16 + 0.22 * sky + 0.66 * key) + 0.05 * rim;
  }

  // Of the picture and of Eq. 1 at the same place of the surface, whatever it is seen from.
  vec3 residualSurface() {
    vec3 normal = normalize(vPosedNormal);
    vec3 toEye = normalize(-vPosed);
    if (dot(normal, toEye) < 0.2) return vec3(0.35);
    vec2 pixel = intrinsics.x * vec2(vPosed.x, -vPosed.y) / -vPosed.z + intrinsics.yz;
    vec2 place = pixel / pictureSize;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return vec3(0.35);
    float seen = dot(decoded(texture(picture, vec2(place.x, 1.0 - place.y)).rgb), vec3(0.2126, 0.7152, 0.0722));
    vec2 terms = eq1(vPosed, normal, toEye, posedLight);
    float difference = seen - shaded(vec3(vReflectance.x), vReflectance.y, normal, terms, vPosedLit).x;
    float strength = clamp(abs(difference) / 0.12, 0.0, 1.0);
    vec3 hue = difference > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    return mix(vec3(0.78), hue, strength);
  }

  // How far shading moved the surface, full colour at 1 cm, over a little clay for its form.
  vec3 changeSurface(vec3 normal, vec3 toEye) {
    float strength = clamp(abs(vShift) / 0.01, 0.0, 1.0);
    vec3 hue = vShift > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    float form = 0.45 + 0.55 * max(dot(normal, toEye), 0.0);
    return form * mix(vec3(0.78), hue, strength);
  }

  void main() {
    vec3 normal = normalize(vNormal);
    vec3 toEye = normalize(eye - vPosition);
    if (!gl_FrontFacing) normal = -normal;
    vec2 terms = eq1(vPosition, normal, toEye, lightVector);
    vec3 linear;
    if (surface == 1) linear = claySurface(normal, toEye);
    else if (surface == 2) linear = vTint;
    else if (surface == 3) linear = vec3(vReflectance.y);
    else if (surface == 4) linear = shaded(vec3(0.5), 0.2, normal, terms, vLit);
    else if (surface == 5) linear = residualSurface();
    else if (surface == 6) linear = changeSurface(normal, toEye);
    else linear = shaded(vTint, vReflectance.y, normal, terms, vLit);
    colour = vec4(encoded(linear), 1.0);
  }
`,I=new s(.74,.66,.58);function k(r,e){let{light:t}=r;return new G({glslVersion:P,vertexShader:D,fragmentShader:U,side:b,uniforms:{surface:{value:0},isPoint:{value:t?.kind==="point"},lightVector:{value:new s(...t?.vector??[0,0,1])},posedLight:{value:new s(...t?.vector??[0,0,1])},lightDistance:{value:t?.distance??1},hasSurroundings:{value:t?.surroundings!=null},surroundings:{value:t?.surroundings??new Array(9).fill(0)},ambient:{value:t?.ambient??.1},exponent:{value:t?.exponent??20},eye:{value:new s},clay:{value:I},picture:{value:e},pictureSize:{value:O(r.camera)},intrinsics:{value:_(r.camera)}}})}function O(r){return new w(r?.width??1,r?.height??1)}function _(r){return new s(r?.fx??1,r?.cx??0,r?.cy??0)}var j=.0028,W=96,H=6,K={colour:10634271,opacity:.8},Y={colour:16753951,opacity:1},Q=.22,p=class{group=new L;tapes=new Map;constructor(e){for(let[t,o]of Object.entries(e)){let i=new d(X(o),new M({transparent:!0}));this.tapes.set(t,i),this.group.add(i)}this.mark(null)}mark(e){let t=e!==null&&this.tapes.has(e);for(let[o,i]of this.tapes){let n=o===e;i.visible=n||g(o);let a=n?Y:K;i.material.color.setHex(a.colour),i.material.opacity=t&&!n?Q:a.opacity,i.material.depthTest=!n,i.renderOrder=n?2:1}}dispose(){for(let e of this.tapes.values())e.geometry.dispose(),e.material.dispose()}};function X(r){let e=r.map(([o,i,n])=>new s(o,i,n)),t=e.length>3&&e[0].equals(e.at(-1));return t&&e.pop(),new C(new A(e,t),W,j,H,t)}var N=class{constructor(e,t,o,i,n){this.body=t;this.upright=o;this.renderer=new B({canvas:e,alpha:!0,antialias:!0}),this.renderer.setPixelRatio(Math.min(window.devicePixelRatio||1,2)),this.renderer.setClearColor(0,0),this.texture=new E(i),this.texture.colorSpace=S,this.texture.generateMipmaps=!1,this.texture.minFilter=x,this.texture.needsUpdate=!0,this.parts=this.added({posed:t,canonical:o}),this.tapes=new p(n),this.scene.add(this.tapes.group),this.table=new z(e,()=>this.draw()),this.place("picture")}body;upright;renderer;scene=new T;table;parts;outlined=null;cues="SES";kind="lit";marked=null;texture;tapes;placement="picture";scheduled=0;isSized=!1;place(e){this.placement=e,this.reveal(),this.table.enabled=e!=="picture",this.renderer.domElement.style.touchAction=e==="picture"?"auto":"none",e!=="picture"&&this.table.lookAt(this.shown(),e==="canonical"?.35:0),this.draw()}surface(e){this.kind=e;for(let t of this.all())t.mesh.material.uniforms.surface.value=F.indexOf(e);this.draw()}compareWith(e){if(!(!e||this.outlined)){if(this.outlined=this.added(e),this.upright&&e.canonical){let t=new u(J(e.canonical,this.upright),1);for(let o of m(this.parts))o.mesh.geometry.setAttribute("shift",t)}this.reveal(),this.draw()}}show(e){this.cues=e,this.reveal(),this.draw()}mark(e){this.marked=e,this.tapes.mark(e),this.draw()}resize(e,t){e===0||t===0||(this.renderer.setSize(e,t,!1),this.table.camera.aspect=e/t,this.isSized=!0,this.render())}turnBy(e){return this.placement!=="picture"&&this.table.turnBy(e)}dispose(){cancelAnimationFrame(this.scheduled),this.table.dispose(),this.texture.dispose(),this.tapes.dispose();for(let e of this.all())e.mesh.geometry.dispose(),e.mesh.material.dispose();this.renderer.dispose()}shown(){let{posed:e,canonical:t}=this.cues==="SE"&&this.outlined||this.parts;return this.placement==="canonical"&&t?t:e}added({posed:e,canonical:t}){let o={posed:V(e,e,this.texture),canonical:t&&V(t,e,this.texture)};for(let i of m(o))this.scene.add(i.mesh);return o}all(){return[...m(this.parts),...this.outlined?m(this.outlined):[]]}reveal(){let e=this.shown();for(let t of this.all())t.mesh.visible=t===e;this.tapes.group.visible=e===this.parts.canonical}draw(){cancelAnimationFrame(this.scheduled),this.scheduled=requestAnimationFrame(()=>this.render())}render(){if(!this.isSized)return;let{mesh:e}=this.shown(),{camera:t}=this.table;this.placement==="picture"?this.useFittedCamera():this.useFreeCamera(),this.setUpright(),e.material.uniforms.eye.value.copy(e.worldToLocal(t.position.clone())),this.renderer.render(this.scene,t);let o=this.cues==="SE"&&this.outlined?"SE":"SES";this.renderer.domElement.dataset.shows=[this.placement,this.kind,o,this.marked??"none"].join(" ")}setUpright(){for(let{posed:e}of[this.parts,this.outlined??this.parts]){let{mesh:t,centre:o}=e;t.quaternion.identity(),this.placement==="turned"&&this.body.upright&&t.quaternion.fromArray(this.body.upright),t.position.copy(o).sub(o.clone().applyQuaternion(t.quaternion)),t.updateMatrixWorld()}}useFreeCamera(){this.table.camera.fov=R,this.table.camera.updateProjectionMatrix()}useFittedCamera(){let{camera:e}=this.body;if(!e)return;let t=.02,o=100,i=this.table.camera;i.position.set(0,0,0),i.quaternion.identity(),i.updateMatrixWorld(),i.projectionMatrix.makePerspective(-e.cx/e.fx*t,(e.width-e.cx)/e.fx*t,e.cy/e.fx*t,-(e.height-e.cy)/e.fx*t,t,o),i.projectionMatrixInverse.copy(i.projectionMatrix).invert()}};function m({posed:r,canonical:e}){return e?[r,e]:[r]}function J(r,e){let[t,o,i]=[r.positions,e.positions,e.normals];return Float32Array.from({length:o.length/3},(n,a)=>{let c=0;for(let l=3*a;l<3*a+3;l++)c+=(o[l]-t[l])*i[l];return c})}function V(r,e,t){let o=r.positions.length/3,i=(h,f)=>new Float32Array(f*o).fill(h),n=new v,a=(h,f,q)=>n.setAttribute(h,new u(f,q));a("position",r.positions,3),a("normal",r.normals,3),a("posed",e.positions,3),a("posedNormal",e.normals,3),a("tint",$(r.colours,e.light?.colourScale??1)??i(.6,3),3),a("albedo",r.albedo??i(.6,1),1),a("specularity",r.specularity??i(0,1),1),a("lit",r.lit??i(1,1),1),a("posedLit",e.lit??i(1,1),1),a("shift",i(0,1),1),n.setIndex(new u(r.triangles,1)),n.computeBoundingBox();let c=n.boundingBox,l=c.getCenter(new s),y=k(e,t);return r!==e&&e.light&&Z(y,e,l),{mesh:new d(n,y),centre:l,height:c.max.y-c.min.y}}function Z(r,e,t){if(e.light.kind!=="point")return;let o=new v;o.setAttribute("position",new u(e.positions,3)),o.computeBoundingBox();let i=o.boundingBox.getCenter(new s);r.uniforms.lightVector.value.sub(i).add(t)}function $(r,e){return r&&r.map(t=>t*e)}export{N as BodyScene};
