import QtQuick
import QtQuick3D
import Passung 1.0

// The scene as it is drawn, for the participant and for the experimenter's mirror: the study says how. Millimetres, z up.
View3D {
    id: view
    required property var scene // SceneModel: what to draw
    property bool shadows: true
    property bool flat: false // for tests: each part in its own colour without light, and nothing else
    property int samples: scene.software && scene.heavy ? 1 : 2 // a pixel
    readonly property color ground: palette3d.ground
    readonly property QtObject palette3d: QtObject {
        readonly property color ground: view.scene.dark ? "#1b242c" : "#e9eef2"
        readonly property color rest: view.scene.dark ? "#8fa3b3" : "#9fb0bd"
        readonly property color otherHeld: view.scene.dark ? "#b9a3d6" : "#a58bc2" // by another hand
        readonly property color held: view.scene.dark ? "#f0b34a" : "#e8a02c"
        readonly property color hit: "#d52e00" // the held part with the visual cue at 1
        readonly property color loose: view.scene.dark ? "#c4b9a0" : "#a39880" // can be picked up
        readonly property color done: view.scene.dark ? "#5f9a80" : "#5b9a7c"
        readonly property color mark: view.scene.dark ? "#56b4e9" : "#0072b2"
    }
    readonly property color heldColor: mixed(palette3d.held, palette3d.hit, scene.cue)

    function mixed(from, to, share) {
        return Qt.rgba(from.r + share * (to.r - from.r), from.g + share * (to.g - from.g), from.b + share * (to.b - from.b), 1);
    }
    function identity(index) {
        return Qt.hsva((0.11 + 0.381966 * index) % 1, 1, 1, 1);
    }

    environment: SceneEnvironment {
        backgroundMode: SceneEnvironment.Color
        clearColor: view.flat ? "black" : view.ground
        antialiasingMode: view.flat || view.samples < 2 ? SceneEnvironment.NoAA : SceneEnvironment.MSAA
        antialiasingQuality: view.samples < 4 ? SceneEnvironment.Medium : SceneEnvironment.High
    }

    PerspectiveCamera {
        position: view.scene.cameraPosition
        rotation: view.scene.cameraRotation
        fieldOfView: view.scene.cameraOpening
        clipNear: view.scene.cameraNear
        clipFar: view.scene.cameraFar
    }

    DirectionalLight {
        rotation: view.scene.lightRotation
        brightness: view.scene.light
        // A little blue, as a sky is.
        ambientColor: Qt.rgba(0.944 * view.scene.ambientLight, view.scene.ambientLight, 1.111 * view.scene.ambientLight, 1.0)
        castsShadow: view.shadows && view.scene.shadow > 0
        shadowMapQuality: view.scene.software ? Light.ShadowMapQualityMedium : Light.ShadowMapQualityHigh
        shadowFactor: 100 * view.scene.shadow
        shadowMapFar: 10 * view.scene.radius
    }
    DirectionalLight {
        rotation: view.scene.cameraRotation
        brightness: view.scene.fillLight
    }

    Model { // the ground
        visible: view.scene.ground && !view.flat
        source: "#Rectangle"
        position: view.scene.groundPosition
        scale: Qt.vector3d(0.01, 0.01, 0.01).times(40 * view.scene.radius)
        castsShadows: false
        materials: PrincipledMaterial {
            baseColor: view.scene.dark ? view.ground : "#c3ccd3"
            roughness: 1.0
            specularAmount: 0.0
        }
    }

    Repeater3D {
        model: view.scene.parts
        delegate: HandFrame {
            id: partFrame
            required property var modelData
            required property int index
            scene: view.scene
            hand: modelData.hand
            Model {
                geometry: PartGeometry {
                    mesh: partFrame.modelData.mesh
                }
                position: partFrame.modelData.held ? view.scene.heldPosition : partFrame.modelData.position
                rotation: partFrame.modelData.held ? view.scene.heldRotation : partFrame.modelData.rotation
                materials: PrincipledMaterial {
                    cullMode: partFrame.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    baseColor: view.flat ? view.identity(partFrame.index)
                        : partFrame.modelData.held ? view.heldColor
                        : partFrame.hand >= 0 ? view.palette3d.otherHeld : view.palette3d.rest
                    lighting: view.flat ? PrincipledMaterial.NoLighting : PrincipledMaterial.FragmentLighting
                    roughness: partFrame.modelData.held ? 0.38 : 0.5
                    metalness: 0.0
                    specularAmount: 0.4
                }
            }
        }
    }

    // In the order of what a part may be: fixed, loose, held, in another hand, done, pale image, to be taken next.
    readonly property var looks: [palette3d.rest, palette3d.loose, heldColor, palette3d.otherHeld, palette3d.done, palette3d.mark, palette3d.mark]
    readonly property var identities: Array.from({ length: view.scene.partCount }, (_, i) => identity(i))
    Repeater3D { // parts that are picked up, those of one surface together
        model: view.scene.surfaces
        delegate: Node {
            id: surface
            required property var modelData
            required property int index
            Model {
                geometry: PartGeometry {
                    mesh: surface.modelData.mesh
                    reach: view.scene.reach
                }
                instancing: PartInstances {
                    placement: view.scene.placement
                    surface: surface.index
                    colours: view.flat ? view.identities : view.looks
                    flat: view.flat
                }
                materials: PrincipledMaterial {
                    cullMode: surface.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    baseColor: "white"
                    lighting: view.flat ? PrincipledMaterial.NoLighting : PrincipledMaterial.FragmentLighting
                    roughness: 0.45
                    metalness: 0.0
                    specularAmount: 0.4
                }
            }
            Model { // where they belong next
                visible: images.count > 0 && !view.flat
                geometry: PartGeometry {
                    mesh: surface.modelData.mesh
                    reach: view.scene.reach
                }
                castsShadows: false
                opacity: 0.28
                instancing: PartInstances {
                    id: images
                    placement: view.scene.placement
                    surface: surface.index
                    images: true
                    colours: view.looks
                }
                materials: PrincipledMaterial {
                    cullMode: surface.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    baseColor: "white"
                    lighting: PrincipledMaterial.NoLighting
                    alphaMode: PrincipledMaterial.Blend
                }
            }
        }
    }

    Repeater3D { // empty hands
        model: view.scene.hands.length
        delegate: Gripper {
            required property int index
            readonly property var hand: index < view.scene.hands.length ? view.scene.hands[index] : null
            visible: hand !== null && hand.empty && !view.flat
            position: hand ? hand.position : Qt.vector3d(0, 0, 0)
            rotation: hand ? hand.rotation : Qt.quaternion(1, 0, 0, 0)
            closed: hand !== null && hand.closed
            size: 0.045 * view.scene.radius
            color: index === 0 ? view.palette3d.held : view.palette3d.otherHeld
        }
    }
    Gripper { // where an empty hand belongs at the start
        visible: view.scene.startsEmpty && view.scene.startMark && !view.flat
        position: view.scene.startPosition
        rotation: view.scene.startRotation
        size: 0.045 * view.scene.radius
        color: view.palette3d.mark
        opacity: 0.45
        pale: true
    }

    Repeater3D { // where the held part belongs at the start
        model: view.scene.ghosts
        delegate: Model {
            required property var modelData
            visible: view.scene.startMark && !view.flat
            geometry: PartGeometry {
                mesh: modelData.mesh
            }
            position: view.scene.startPosition
            rotation: view.scene.startRotation
            castsShadows: false
            opacity: 0.28
            materials: PrincipledMaterial {
                cullMode: modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                baseColor: view.palette3d.mark
                lighting: PrincipledMaterial.NoLighting
                alphaMode: PrincipledMaterial.Blend
            }
        }
    }

    Repeater3D { // what the trial asks for
        model: view.scene.marks
        delegate: HandFrame {
            id: markFrame
            required property var modelData
            scene: view.scene
            hand: modelData.hand
            Model {
                // One pale image at a time.
                visible: !view.flat && !(markFrame.modelData.pale && view.scene.startMark)
                geometry: PartGeometry {
                    mesh: markFrame.modelData.mesh
                }
                position: markFrame.modelData.position
                rotation: markFrame.modelData.rotation
                castsShadows: false
                opacity: markFrame.modelData.pale ? 0.28 : 1
                materials: PrincipledMaterial {
                    baseColor: view.palette3d.mark
                    lighting: PrincipledMaterial.NoLighting
                    cullMode: markFrame.modelData.twoSided ? Material.NoCulling : Material.BackFaceCulling
                    alphaMode: markFrame.modelData.pale ? PrincipledMaterial.Blend : PrincipledMaterial.Opaque
                }
            }
        }
    }

    Node { // the force on the hand
        visible: view.scene.arrow && !view.flat
        position: view.scene.arrowPosition
        rotation: view.scene.arrowRotation
        readonly property real thick: 0.028 * view.scene.radius
        Model {
            source: "#Cylinder"
            castsShadows: false
            position: Qt.vector3d(0, 0.5 * view.scene.arrowLength, 0)
            scale: Qt.vector3d(0.01 * parent.thick, 0.01 * view.scene.arrowLength, 0.01 * parent.thick)
            materials: arrowMaterial
        }
        Model {
            source: "#Cone"
            castsShadows: false
            position: Qt.vector3d(0, view.scene.arrowLength, 0)
            scale: Qt.vector3d(0.028 * parent.thick, 0.035 * parent.thick, 0.028 * parent.thick)
            materials: arrowMaterial
        }
    }
    PrincipledMaterial {
        id: arrowMaterial
        baseColor: "#d55e00"
        lighting: PrincipledMaterial.NoLighting
    }
}
