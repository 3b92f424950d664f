def main():
    print('Hello from my_mission.')


if __name__ == '__main__':
    main()
