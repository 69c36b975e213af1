#include "ui/window/speaker.h"

#include <QtCore/QFile>
#include <QtCore/QIODevice>
#include <QtCore/QThread>
#include <QtMultimedia/QAudioDevice>
#include <QtMultimedia/QAudioSink>
#include <QtMultimedia/QMediaDevices>
#include <vector>

namespace passung::window {

namespace {

constexpr double kBuffer = 0.02;  // [s], asked for; the output may take more

/// Is there a sound server to connect to? Qt Multimedia complains on the console if there is none.
bool hasServer() {
    if (qEnvironmentVariableIsSet("PULSE_SERVER")) return true;
    const QString own = qEnvironmentVariable("PULSE_RUNTIME_PATH", qEnvironmentVariable("XDG_RUNTIME_DIR") + "/pulse");
    return QFile::exists(own + "/native");
}

/// The feed as Qt's sinks read it, whenever they have room.
class Samples final : public QIODevice {
public:
    Samples(sound::SoundFeed& feed, int channels) : feed_(feed), channels_(channels) { open(QIODevice::ReadOnly); }
    bool isSequential() const override { return true; }
    qint64 bytesAvailable() const override { return 1 << 16; }

protected:
    qint64 readData(char* data, qint64 most) override {
        const auto frames = static_cast<std::size_t>(most) / (sizeof(float) * static_cast<std::size_t>(channels_));
        samples_.resize(frames);
        feed_.fill(samples_);
        auto* out = reinterpret_cast<float*>(data);
        for (const float sample : samples_)
            for (int channel = 0; channel < channels_; ++channel) *out++ = sample;
        return static_cast<qint64>(frames * sizeof(float)) * channels_;
    }
    qint64 writeData(const char*, qint64) override { return -1; }

private:
    sound::SoundFeed& feed_;
    int channels_;
    std::vector<float> samples_;
};

/// The sink lives and is served in this thread.
class Player final : public Speaker {
public:
    explicit Player(sound::SoundFeed& feed) : feed_(feed) {
        QObject::connect(&thread_, &QThread::started, &worker_, [this] { open(); });
        QObject::connect(
            &thread_, &QThread::finished, &worker_, [this] { close(); }, Qt::DirectConnection);
        worker_.moveToThread(&thread_);
        thread_.start(QThread::TimeCriticalPriority);
    }
    ~Player() override {
        thread_.quit();
        thread_.wait();
    }

private:
    void open() {
        feed_.setOutput(std::nullopt);
        if (!hasServer()) return;
        const QAudioDevice device = QMediaDevices::defaultAudioOutput();
        if (device.isNull()) return;
        QAudioFormat format;
        format.setSampleRate(sound::SoundFeed::kRate);
        format.setChannelCount(2);
        format.setSampleFormat(QAudioFormat::Float);
        if (!device.isFormatSupported(format)) return;
        sink_ = std::make_unique<QAudioSink>(device, format);
        sink_->setBufferSize(format.bytesForDuration(static_cast<qint64>(1e6 * kBuffer)));
        samples_ = std::make_unique<Samples>(feed_, format.channelCount());
        QObject::connect(sink_.get(), &QAudioSink::stateChanged, &worker_, [this, format, device](QAudio::State state) {
            if (state == QAudio::StoppedState) return feed_.setOutput(std::nullopt);
            feed_.setOutput(sound::SoundOutput{
                device.description().toStdString(),
                static_cast<double>(format.durationForBytes(static_cast<qint32>(sink_->bufferSize())))});
        });
        sink_->start(samples_.get());
    }
    /// In the thread that is about to end.
    void close() {
        sink_.reset();
        samples_.reset();
        feed_.setOutput(std::nullopt);
    }

    sound::SoundFeed& feed_;
    QObject worker_;
    std::unique_ptr<Samples> samples_;
    std::unique_ptr<QAudioSink> sink_;
    QThread thread_;
};

}  // namespace

std::unique_ptr<Speaker> openSpeaker(sound::SoundFeed& feed) { return std::make_unique<Player>(feed); }

}  // namespace passung::window
