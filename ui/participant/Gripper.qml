import QtQuick
import QtQuick3D

// A hand that holds nothing: two fingers about its point, apart or closed.
Node {
    id: gripper
    property bool closed: false
    property bool pale: false // an image only
    property real size: 1 // half of a finger's length [mm]
    property color color
    readonly property real spread: (closed ? 0.55 : 1.4) * size

    Model { // its point
        source: "#Sphere"
        castsShadows: !gripper.pale
        scale: Qt.vector3d(0.01, 0.01, 0.01).times((gripper.closed ? 0.7 : 0.55) * gripper.size)
        materials: skin
    }
    Model { // a finger
        source: "#Cube"
        castsShadows: !gripper.pale
        position: Qt.vector3d(-gripper.spread, 0, 0.6 * gripper.size)
        scale: Qt.vector3d(0.004, 0.008, 0.022).times(gripper.size)
        materials: skin
    }
    Model { // the other
        source: "#Cube"
        castsShadows: !gripper.pale
        position: Qt.vector3d(gripper.spread, 0, 0.6 * gripper.size)
        scale: Qt.vector3d(0.004, 0.008, 0.022).times(gripper.size)
        materials: skin
    }
    Model { // what the fingers hang from
        source: "#Cube"
        castsShadows: !gripper.pale
        position: Qt.vector3d(0, 0, 1.8 * gripper.size)
        scale: Qt.vector3d(gripper.closed ? 0.015 : 0.032, 0.008, 0.004).times(gripper.size)
        materials: skin
    }
    PrincipledMaterial {
        id: skin
        baseColor: gripper.color
        lighting: gripper.pale ? PrincipledMaterial.NoLighting : PrincipledMaterial.FragmentLighting
        alphaMode: gripper.pale ? PrincipledMaterial.Blend : PrincipledMaterial.Opaque
        roughness: 0.4
        specularAmount: 0.4
    }
}
